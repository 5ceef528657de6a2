#include "engine/io/video/frame_source.h"

#include "engine/io/files/checksum.h"
#include "engine/io/files/numbered_names.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/frame_test_support.h"

namespace vantage::frame_source_test {

TEST(FrameSource, AFolderIsReadInNaturalOrder) {
  const TemporaryFolder folder;
  for (const int i : {10, 9, 100, 2}) {
    put_image(folder / ("frame" + std::to_string(i) + ".png"), i);
  }
  put_image(folder / "frame11.PGM", 11);
  put_image(folder / ".hidden3.png", 3);
  put_text(folder / "calib.txt", "not an image");
  std::filesystem::create_directory(folder / "frame5.png");
  const auto source = open_frame_source(folder.path().string());
  EXPECT_EQ(source->frame_count(), 5);
  EXPECT_EQ(source->describe(1), folder / "frame9.png");
  EXPECT_EQ(source->number_of(4), 100);
  EXPECT_EQ(source->frame_rate(), std::nullopt);
  EXPECT_EQ(source->video_file(), "");
  EXPECT_EQ(values_of(*source), (std::vector<int>{2, 9, 10, 11, 100}));
}

TEST(FrameSource, APatternBeginsAtTheSmallestNumber) {
  const TemporaryFolder folder;
  for (const int i : {8, 9, 10, 11}) {
    char name[16];
    std::snprintf(name, sizeof(name), "l%04d.png", i);
    put_image(folder / name, i);
  }
  put_image(folder / "l12.png", 12);     // too few digits
  put_image(folder / "l00013.png", 13);  // too many
  put_image(folder / "r0001.png", 1);
  const auto source = open_frame_source(folder / "l%04d.png");
  EXPECT_EQ(source->frame_count(), 4);
  EXPECT_EQ(source->describe(0), folder / "l0008.png");
  EXPECT_EQ(values_of(*source), (std::vector<int>{8, 9, 10, 11}));
}

TEST(FrameSource, APatternWithoutWidthAndWithAPercentSign) {
  const TemporaryFolder folder;
  put_image(folder / "5%9_a.png", 9);
  put_image(folder / "5%10_a.png", 10);
  const auto source = open_frame_source(folder / "5%%%d_a.png");
  EXPECT_EQ(values_of(*source), (std::vector<int>{9, 10}));
}

/// As many as there are seconds, say, or nanoseconds, between two names.
TEST(FrameSource, RefusesPatternsOfWhichHardlyANumberIsThere) {
  const TemporaryFolder folder;
  put_image(folder / "p_0.png", 50);
  put_image(folder / "p_201.png", 51);
  EXPECT_EQ(open_frame_source(folder / "p_%d.png")->frame_count(), 202);
  for (const char* far : {"p_203.png", "p_2000000000.png"}) {
    put_image(folder / far, 52);
    std::filesystem::remove(folder / "p_201.png");
    EXPECT_THAT(error_of([&] { open_frame_source(folder / "p_%d.png"); }),
                testing::AllOf(HasSubstr("p_%d.png"), HasSubstr(folder / "p_*.png")));
  }
  EXPECT_EQ(open_frame_source(folder / "p_*.png")->frame_count(), 3);
}

TEST(FrameSource, AMissingNumberIsABadFrameAndTheNextOneFollows) {
  const TemporaryFolder folder;
  put_image(folder / "0.png", 50);
  put_image(folder / "2.png", 52);
  const auto source = open_frame_source(folder / "%d.png");
  EXPECT_EQ(source->frame_count(), 3);
  Photograph frame;
  EXPECT_TRUE(source->next(frame));
  EXPECT_THAT(error_of([&] { source->next(frame); }),
              testing::AllOf(HasSubstr("1.png"), HasSubstr("no such file")));
  EXPECT_EQ(values_of(*source), (std::vector<int>{52}));
}

TEST(FrameSource, AGlobTakesWhatMatchesInNaturalOrder) {
  const TemporaryFolder folder;
  for (const int i : {3, 20, 100}) {
    put_image(folder / ("a" + std::to_string(i) + ".png"), i);
    put_image(folder / ("b" + std::to_string(i) + ".png"), 0);
  }
  EXPECT_EQ(values_of(*open_frame_source(folder / "a*.png")), (std::vector<int>{3, 20, 100}));
  EXPECT_EQ(values_of(*open_frame_source(folder / "a[3]*.png")), (std::vector<int>{3}));
}

TEST(FrameSource, ANameThatExistsIsNoPattern) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "take[1] 50%");
  put_image(folder / "take[1] 50%/a.png", 7);
  EXPECT_EQ(values_of(*open_frame_source(folder / "take[1] 50%")), (std::vector<int>{7}));
  EXPECT_EQ(values_of(*open_frame_source(folder / "take[1] 50%/a.png")), (std::vector<int>{7}));
}

TEST(FrameSource, AVideoGivesItsFramesAndItsRate) {
  const TemporaryFolder folder;
  put_video(folder / "v.mp4", {20, 120, 220}, {24000, 1001});
  const auto source = open_frame_source(folder / "v.mp4");
  EXPECT_EQ(source->frame_count(), 3);
  EXPECT_EQ(source->frame_rate(), (FrameRate{24000, 1001}));
  EXPECT_EQ(source->describe(2), folder / "v.mp4" + " frame 2");
  EXPECT_EQ(source->number_of(2), std::nullopt);
  EXPECT_EQ(source->video_file(), folder / "v.mp4");
  const std::vector<int> values = values_of(*source);
  ASSERT_EQ(values.size(), 3U);
  EXPECT_NEAR(values[0], 20, 4);
  EXPECT_NEAR(values[2], 220, 4);
}

TEST(FrameSource, FetchingReadsNoImageFile) {
  const TemporaryFolder folder;
  put_image(folder / "1.png", 11);
  const auto source = open_frame_source(folder / "1.png");
  FetchedFrame frame;
  ASSERT_TRUE(source->fetch(frame));
  EXPECT_EQ(frame.file, folder / "1.png");
  EXPECT_EQ(frame.photograph.width(), 0);
  frame.decode();
  EXPECT_EQ(value_of(frame.photograph), 11);
  EXPECT_FALSE(source->fetch(frame));
}

/// The next frame, or what is wrong with it.
struct Outcome {
  bool is_frame = false;
  Photograph frame;
  std::string problem;
};

std::optional<Outcome> next_outcome(FrameSource& source) {
  Outcome outcome;
  try {
    outcome.is_frame = source.next(outcome.frame);
    return outcome.is_frame ? std::optional(std::move(outcome)) : std::nullopt;
  } catch (const Error& error) {
    outcome.problem = error.what();
    return outcome;
  }
}

/// What follows skip_to() is what a source gives that is read from the start, bad frames too.
void expect_to_skip_everywhere(const std::string& spec) {
  const auto sequential = open_frame_source(spec);
  std::vector<Outcome> outcomes;
  while (std::optional<Outcome> outcome = next_outcome(*sequential)) {
    outcomes.push_back(std::move(*outcome));
  }
  const int count = sequential->frame_count();
  ASSERT_EQ(static_cast<int>(outcomes.size()), count);
  const auto source = open_frame_source(spec);
  for (int from = 0; from <= count; ++from) {
    for (int to = 0; to <= count; ++to) {
      source->skip_to(from);
      EXPECT_EQ(next_outcome(*source).has_value(), from < count);
      source->skip_to(to);
      const std::optional<Outcome> outcome = next_outcome(*source);
      ASSERT_EQ(outcome.has_value(), to < count) << from << " " << to;
      if (outcome) {
        const Outcome& expected = outcomes[static_cast<std::size_t>(to)];
        EXPECT_EQ(outcome->is_frame, expected.is_frame) << from << " " << to;
        EXPECT_TRUE(same(outcome->frame, expected.frame)) << from << " " << to;
      }
    }
  }
}

TEST(FrameSource, SkipsToAnyFrame) {
  const TemporaryFolder folder;
  put_images(folder / "images", {0, 1, 2, 3});
  expect_to_skip_everywhere(folder / "images");
  expect_to_skip_everywhere(folder / "images/%06d.png");
  put_video(folder / "v.mp4", {10, 60, 110, 160, 210});
  expect_to_skip_everywhere(folder / "v.mp4");
}

TEST(FrameSource, BehindDamageAllFramesOfAVideoAreBad) {
  const TemporaryFolder folder;
  constexpr int kFrames = 8;
  VideoWriter writer(folder / "v.mp4", 64, 64, {});
  for (unsigned i = 0; i < kFrames; ++i) {
    writer.write(noise<std::uint8_t>(64, 64, 3, i));
  }
  writer.finish();
  std::vector<std::uint8_t> bytes = bytes_of(folder / "v.mp4");
  std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 2), 2000, 0);
  put_bytes(folder / "v.mp4", bytes);
  const auto source = open_frame_source(folder / "v.mp4");
  ASSERT_EQ(source->frame_count(), kFrames);
  std::vector<std::string> problems;
  while (std::optional<Outcome> outcome = next_outcome(*source)) {
    problems.push_back(outcome->problem);
  }
  ASSERT_EQ(static_cast<int>(problems.size()), kFrames);
  EXPECT_EQ(problems.front(), "");
  const auto first_bad = std::ranges::find_if(problems, [](const auto& p) { return !p.empty(); });
  ASSERT_NE(first_bad, problems.end());
  ASSERT_LT(first_bad + 1, problems.end());
  EXPECT_THAT(*first_bad, testing::StartsWith(folder / "v.mp4"));
  for (auto problem = first_bad + 1; problem != problems.end(); ++problem) {
    EXPECT_THAT(*problem,
                testing::StartsWith(source->describe(static_cast<int>(problem - problems.begin())) +
                                    ": follows damage (" + *first_bad));
  }
  expect_to_skip_everywhere(folder / "v.mp4");
}

TEST(FrameSource, TheIdentityTellsWhetherFilesAreTheSame) {
  const TemporaryFolder folder;
  const std::string images = folder / "images";
  put_images(images, {0, 1, -1, 3});
  const auto identity_of = [](const std::string& spec) {
    return open_frame_source(spec)->identity();
  };
  const std::string before = identity_of(images);
  EXPECT_THAT(before, testing::StartsWith("images " + images + ": 3 files, "));
  EXPECT_EQ(identity_of(images), before);
  EXPECT_NE(identity_of(images + "/%06d.png"), before);
  EXPECT_THAT(identity_of(images + "/%06d.png"), HasSubstr(": 3 files, "));
  EXPECT_NE(identity_of(images + "/*.png"), before) << "another name";
  const auto files_of = [](const std::string& identity) {
    return identity.substr(identity.rfind(": "));
  };
  EXPECT_EQ(files_of(identity_of(images + "/*.png")), files_of(before)) << "the same files";

  const std::filesystem::path file = images + "/000001.png";
  const auto time = std::filesystem::last_write_time(file);
  std::filesystem::last_write_time(file, time + std::chrono::milliseconds(1));
  EXPECT_NE(identity_of(images), before) << "another time";
  std::filesystem::last_write_time(file, time);
  EXPECT_EQ(identity_of(images), before);
  put_text(file, "of another size");
  std::filesystem::last_write_time(file, time);
  EXPECT_NE(identity_of(images), before);
  std::filesystem::rename(file, images + "/000002.png");
  const std::string renamed = identity_of(images);
  std::filesystem::rename(images + "/000002.png", file);
  EXPECT_NE(identity_of(images), renamed);
  put_video(folder / "v.mp4", {1});
  EXPECT_THAT(identity_of(folder / "v.mp4"),
              testing::StartsWith("video " + (folder / "v.mp4") + ": 1 file, "));
}

TEST(FrameSource, RefusesWhatMatchesNothing) {
  const TemporaryFolder folder;
  const auto refuse = [](const std::filesystem::path& spec, const char* expected) {
    EXPECT_THAT(error_of([&] { open_frame_source(spec.string()); }), HasSubstr(expected));
  };
  refuse(folder.path(), "holds no image");
  refuse(folder / "no", "no such file");
  refuse(folder / "%d.png", "no file matches");
  refuse(folder / "no/%d.png", "cannot read the folder");
  refuse(folder / "*.png", "no file matches");
  refuse("", "no such file");
  put_text(folder / "notes.txt", "just text in here, not a video\n");
  refuse(folder / "notes.txt", "not a video");
  for (const char* bad :
       {"%s.png", "%d_%d.png", "%", "%6d.png", "%012d.png", "%00d.png", "a%%.png", "%0d.png"}) {
    EXPECT_THROW(open_frame_source(folder / bad), UsageError) << bad;
  }
}

TEST(FrameNumber, IsTheLastOneInTheName) {
  EXPECT_EQ(frame_number("left_0012.png"), 12);
  EXPECT_EQ(frame_number("3/cam1_7b.tar.png"), 7);
  EXPECT_EQ(frame_number("12"), 12);
  EXPECT_EQ(frame_number("0"), 0);
  EXPECT_EQ(frame_number("a-5.png"), 5);
  EXPECT_EQ(frame_number("999999999999999999.png"), 999999999999999999);
  EXPECT_EQ(frame_number("1000000000000000000.png"), std::nullopt);
  EXPECT_EQ(frame_number("5/left.png7"), std::nullopt);
  EXPECT_EQ(frame_number(""), std::nullopt);
}

TEST(Fnv1aHash, GivesThePublishedValues) {
  const auto hash_of = [](std::string_view text) {
    Fnv1aHash hash;
    hash.add(text);
    return hash.value();
  };
  EXPECT_EQ(hash_of(""), 0xcbf29ce484222325U);
  EXPECT_EQ(hash_of("a"), 0xaf63dc4c8601ec8cU);
  EXPECT_EQ(hash_of("foobar"), 0x85944171f73967e8U);
  Fnv1aHash of_number;
  of_number.add(std::uint64_t{0x0201});
  EXPECT_EQ(of_number.value(), hash_of(std::string_view("\1\2\0\0\0\0\0\0", 8)));
}

TEST(NaturalOrder, CountsNumbersAndIsAStrictTotalOrder) {
  const std::vector<std::filesystem::path> ordered = {"",
                                                      "1",
                                                      "01",
                                                      "2",
                                                      "10",
                                                      "a",
                                                      "a/2.png",
                                                      "a/10.png",
                                                      "a1",
                                                      "a1b2",
                                                      "a1b10",
                                                      "a1c",
                                                      "a02",
                                                      "b",
                                                      "b99999999999999999999998",
                                                      "b99999999999999999999999"};
  for (std::size_t i = 0; i < ordered.size(); ++i) {
    for (std::size_t j = 0; j < ordered.size(); ++j) {
      if (ordered[i] == "1" && ordered[j] == "01") {
        continue;  // equal values: by characters
      }
      if (ordered[i] == "01" && ordered[j] == "1") {
        EXPECT_TRUE(comes_before_naturally(ordered[i], ordered[j]));
        continue;
      }
      EXPECT_EQ(comes_before_naturally(ordered[i], ordered[j]), i < j)
          << ordered[i] << " " << ordered[j];
    }
  }
}

}  // namespace vantage::frame_source_test
