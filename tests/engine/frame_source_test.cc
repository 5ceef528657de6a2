#include "engine/io/frame_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "engine/io/natural_order.h"
#include "engine/io/photograph_io.h"
#include "engine/io/video_io.h"
#include "engine/io/wildcard.h"
#include "tests/engine/io_test_support.h"

namespace vantage {
namespace {

using test::error_of;
using test::put_text;
using ::testing::HasSubstr;

/// A 2×1 image whose value tells it from the others.
void put_image(const std::filesystem::path& path, int value) {
  Photograph photograph{Image<std::uint8_t>(2, 1)};
  std::get<Image<std::uint8_t>>(photograph.pixels).fill(static_cast<std::uint8_t>(value));
  write_photograph(path, photograph);
}

std::vector<int> values_of(FrameSource& source) {
  std::vector<int> values;
  Photograph frame;
  while (source.next(frame)) {
    values.push_back(std::get<Image<std::uint8_t>>(frame.pixels).at(0, 0));
  }
  return values;
}

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
  EXPECT_EQ(source->frames_per_second(), std::nullopt);
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
  VideoWriter writer(folder / "v.mp4", 32, 32, 24);
  Photograph frame{Image<std::uint8_t>(32, 32)};
  for (const int value : {20, 120, 220}) {
    std::get<Image<std::uint8_t>>(frame.pixels).fill(static_cast<std::uint8_t>(value));
    writer.write(frame);
  }
  writer.finish();
  const auto source = open_frame_source(folder / "v.mp4");
  EXPECT_EQ(source->frame_count(), 3);
  EXPECT_NEAR(source->frames_per_second().value_or(0), 24, 1e-6);
  EXPECT_EQ(source->describe(2), folder / "v.mp4" + " frame 2");
  const std::vector<int> values = values_of(*source);
  ASSERT_EQ(values.size(), 3U);
  EXPECT_NEAR(values[0], 20, 4);
  EXPECT_NEAR(values[2], 220, 4);
}

TEST(FrameSource, ABadFrameIsNamed) {
  const TemporaryFolder folder;
  put_image(folder / "1.png", 1);
  put_text(folder / "2.png", "garbage");
  put_image(folder / "3.png", 3);
  const auto source = open_frame_source(folder.path().string());
  Photograph frame;
  EXPECT_TRUE(source->next(frame));
  EXPECT_THAT(error_of([&] { source->next(frame); }), HasSubstr("2.png"));
  EXPECT_EQ(values_of(*source), (std::vector<int>{3}));
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
       {"%s.png", "%d_%d.png", "%", "%6d.png", "%012d.png", "a%%.png", "%0d.png"}) {
    EXPECT_THROW(open_frame_source(folder / bad), UsageError) << bad;
  }
}

TEST(Wildcard, MatchesAsTheShellDoes) {
  struct Case {
    const char* pattern;
    const char* name;
    bool matches;
  };
  for (const Case& c : {Case{"*", "", true},
                        Case{"*", "abc", true},
                        Case{"*", ".abc", false},
                        Case{".*", ".abc", true},
                        Case{"a*c", "abbbc", true},
                        Case{"a*c", "abbb", false},
                        Case{"*ab*ab", "abxabyab", true},
                        Case{"*ab*ab", "xab", false},
                        Case{"a?c", "abc", true},
                        Case{"a?c", "ac", false},
                        Case{"[0-9]x", "5x", true},
                        Case{"[!0-9]x", "5x", false},
                        Case{"[!0-9]x", "ax", true},
                        Case{"[]a]", "]", true},
                        Case{"[a-]", "-", true},
                        Case{"[ab", "[ab", true},
                        Case{"", "", true},
                        Case{"", "a", false},
                        Case{"a**", "a", true},
                        Case{"a[", "a[", true},
                        Case{"[!", "[!", true}}) {
    EXPECT_EQ(matches_wildcard(c.pattern, c.name), c.matches) << c.pattern << " " << c.name;
  }
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

}  // namespace
}  // namespace vantage
