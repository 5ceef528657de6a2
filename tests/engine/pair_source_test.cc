#include "engine/sequence/pairs/pair_source.h"

#include "engine/sequence/pairs/supplied_pairs.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/frame_test_support.h"
#include "tests/test_paths.h"

namespace vantage::pair_source_test {

using ::testing::Pair;

using Values = std::vector<std::pair<int, int>>;
constexpr std::pair<int, int> kBad = {-1, -1};

PairSourceOptions two_cameras(const std::string& left, const std::string& right, int offset = 0) {
  PairSourceOptions options;
  options.left = left;
  options.right = right;
  options.offset_frames = offset;
  return options;
}

PairSourceOptions packed_in(const std::string& stereo, StereoPacking packing) {
  PairSourceOptions options;
  options.stereo = stereo;
  options.packing = packing;
  return options;
}

PairSourceOptions listed_in(const std::string& pairs) {
  PairSourceOptions options;
  options.pairs = pairs;
  return options;
}

PairSourceOptions moving_camera(const std::string& sequence, int step = 1) {
  PairSourceOptions options;
  options.sequence = sequence;
  options.step = step;
  return options;
}

/// Values of left and right of the pairs that are left; kBad for those that throw.
Values pairs_of(PairSource& source) {
  Values values;
  FramePair pair;
  for (;;) {
    try {
      if (!source.fetch(pair)) {
        return values;
      }
      source.decode(pair);
      values.emplace_back(value_of(pair.left), value_of(pair.right));
    } catch (const Error&) {
      values.push_back(kBad);
    }
  }
}

Values pairs_of(const PairSourceOptions& options) { return pairs_of(*open_pair_source(options)); }

/// Counting from `first` in steps that survive a video codec.
std::vector<int> counting(int first, int count) {
  std::vector<int> values;
  for (int i = 0; i < count; ++i) {
    values.push_back(first + 20 * i);
  }
  return values;
}

/// Values of a video's frames, rounded to what counting() made.
Values rounded(Values values, int left_first, int right_first) {
  const auto round = [](int& value, int first) { value = (value - first + 5) / 20 * 20 + first; };
  for (auto& [left, right] : values) {
    round(left, left_first);
    round(right, right_first);
  }
  return values;
}

/// After skip_to(i) the pairs are those of a source that gave the i before, bad ones too; from any
/// place to any other.
void expect_to_skip_everywhere(const PairSourceOptions& options) {
  const Values all = pairs_of(options);
  const auto source = open_pair_source(options);
  const int count = source->pair_count();
  ASSERT_EQ(static_cast<int>(all.size()), count);
  for (int from = 0; from <= count; ++from) {
    for (int to = 0; to <= count; ++to) {
      source->skip_to(from);
      FramePair pair;
      try {
        EXPECT_EQ(source->fetch(pair), from < count);
        EXPECT_EQ(pair.index, from < count ? from : 0);
      } catch (const Error&) {
      }
      source->skip_to(to);
      EXPECT_EQ(pairs_of(*source), Values(all.begin() + to, all.end())) << from << " " << to;
    }
  }
}

/// Left values as pairs_of() gives them, whether or not the right images are wanted, which may
/// change from pair to pair.
void expect_left_images_alone(const PairSourceOptions& options) {
  const Values all = pairs_of(options);
  const auto source = open_pair_source(options);
  for (const unsigned wanted : {0U, 0b01001U, 0b10110U}) {
    source->skip_to(0);
    for (unsigned index = 0; index < all.size(); ++index) {
      FramePair pair;
      pair.wants_right = (wanted >> index & 1U) != 0;
      ASSERT_TRUE(source->fetch(pair));
      source->decode(pair);
      EXPECT_EQ(pair.index, static_cast<int>(index));
      EXPECT_EQ(value_of(pair.left), all[index].first) << wanted << " " << index;
      if (pair.wants_right) {
        EXPECT_EQ(value_of(pair.right), all[index].second) << wanted << " " << index;
      }
    }
    FramePair pair;
    EXPECT_FALSE(source->fetch(pair));
  }
}

TEST(PairSource, WhiteLevelIsThatOfTheWholeInput) {
  const TemporaryFolder folder;
  for (const std::string side : {"l/", "r/"}) {
    std::filesystem::create_directories(folder / side);
    for (int i = 0; i < 9; ++i) {  // fades in; of eight, pair 7 is not looked at
      Image<std::uint16_t> image(2, 1);
      image.fill(static_cast<std::uint16_t>(i == 7 ? 5000 : 500 * i));
      image.at(1, 0) = static_cast<std::uint16_t>(i);
      write_photograph(folder / (side + std::to_string(i) + ".png"), {std::move(image)});
    }
  }
  PairSourceOptions options = two_cameras(folder / "l", folder / "r");
  const auto source = open_pair_source(options);
  EXPECT_EQ(source->white_level().value, 4095);
  FramePair pair;
  const auto value_at = [&](PairSource& from, int index) {
    from.skip_to(index);
    EXPECT_TRUE(from.fetch(pair));
    from.decode(pair);
    return std::get<Image<std::uint16_t>>(pair.right.pixels).at(0, 0);
  };
  EXPECT_EQ(value_at(*source, 1), std::lround(500 * 65535 / 4095.0));
  EXPECT_THAT(pair.remarks, IsEmpty());
  EXPECT_EQ(value_at(*source, 7), 65535);
  EXPECT_THAT(pair.remarks, ElementsAre("50 % of its values are above the white level"));
  options.white_level = 65535;
  EXPECT_EQ(value_at(*open_pair_source(options), 1), 500);
  options.white_level = 70000;
  EXPECT_THAT(error_of([&] { open_pair_source(options); }), HasSubstr("at most 65535"));
  options.white_level = -1;
  EXPECT_THROW(open_pair_source(options), UsageError);
}

TEST(PairSource, LeftImagesAlone) {
  const TemporaryFolder folder;
  put_images(folder / "l", {0, 1, 2, 3, 4});
  put_images(folder / "r", {99, 100, 101, 102, 103, 104});
  put_video(folder / "l.mp4", counting(20, 5));
  put_video(folder / "r.mp4", counting(30, 6));
  expect_left_images_alone(two_cameras(folder / "l", folder / "r", 1));
  expect_left_images_alone(two_cameras(folder / "l.mp4", folder / "r.mp4", 1));
  expect_left_images_alone(two_cameras(folder / "l", folder / "r.mp4", 1));
  for (const int step : {1, -2}) {
    expect_left_images_alone(moving_camera(folder / "r", step));
    expect_left_images_alone(moving_camera(folder / "r.mp4", step));
  }
  // What is not wanted is not read.
  put_text(folder / "r/000003.png", "garbage");
  for (const PairSourceOptions& options :
       {two_cameras(folder / "l", folder / "r"), moving_camera(folder / "r", -1)}) {
    const auto source = open_pair_source(options);
    FramePair pair;
    pair.wants_right = false;
    source->skip_to(3);
    ASSERT_TRUE(source->fetch(pair));
    EXPECT_NO_THROW(source->decode(pair));
    pair.wants_right = true;
    source->skip_to(3);
    ASSERT_TRUE(source->fetch(pair));
    EXPECT_THROW(source->decode(pair), Error);
  }
}

TEST(PairSource, TwoFolders) {
  const TemporaryFolder folder;
  put_images(folder / "l", {0, 1, 2, 3});
  put_images(folder / "r", {100, 101, 102, 103});
  PairSourceOptions options = two_cameras(folder / "l", folder / "r/%06d.png");
  const auto source = open_pair_source(options);
  EXPECT_EQ(source->pair_count(), 4);
  EXPECT_EQ(source->describe(1), folder / "l/000001.png" + ", " + folder / "r/000001.png");
  EXPECT_THAT(source->pairing().left_out, ElementsAre(0, 0));
  EXPECT_THAT(source->remarks(), IsEmpty());
  EXPECT_EQ(source->frames_kept(), 0);
  EXPECT_EQ(source->frame_rate(), std::nullopt);
  EXPECT_EQ(source->sound().file, "");
  EXPECT_THAT(source->identities(),
              ElementsAre(HasSubstr("images " + options.left + ": 4 files"),
                          HasSubstr("images " + options.right + ": 4 files")));
  EXPECT_EQ(pairs_of(*source), (Values{{0, 100}, {1, 101}, {2, 102}, {3, 103}}));
}

TEST(PairSource, Offsets) {
  const TemporaryFolder folder;
  put_images(folder / "l", {0, 1, 2, 3});
  put_images(folder / "r", {100, 101, 102, 103});
  PairSourceOptions options = two_cameras(folder / "l", folder / "r");
  options.offset_frames = 1;
  EXPECT_EQ(pairs_of(options), (Values{{0, 101}, {1, 102}, {2, 103}}));
  EXPECT_TRUE(open_pair_source(options)->pairing().is_whole());
  EXPECT_THAT(open_pair_source(options)->remarks(), IsEmpty());
  expect_to_skip_everywhere(options);
  options.offset_frames = -3;
  EXPECT_EQ(pairs_of(options), (Values{{3, 100}}));
  EXPECT_EQ(open_pair_source(options)->describe(0),
            folder / "l/000003.png" + ", " + folder / "r/000000.png");
  for (const int too_far : {4, -4, 1000000, -1000000}) {
    options.offset_frames = too_far;
    EXPECT_THAT(error_of([&] { open_pair_source(options); }), HasSubstr("no frame has a partner"));
  }
}

TEST(PairSource, UnequalLengths) {
  const TemporaryFolder folder;
  put_images(folder / "l", {0, 1, 2, 3, 4});
  put_images(folder / "r", {0, 1, 2});
  PairSourceOptions options = two_cameras(folder / "l", folder / "r");
  const auto unpaired = [&](int offset_frames) {
    options.offset_frames = offset_frames;
    options.pair_by = std::nullopt;
    const Pairing by_name = open_pair_source(options)->pairing();
    options.pair_by = PairBy::kOrder;
    EXPECT_EQ(open_pair_source(options)->pairing().left_out, by_name.left_out) << offset_frames;
    return by_name.left_out[0] + by_name.left_out[1];
  };
  EXPECT_EQ(unpaired(0), 2);
  EXPECT_THAT(open_pair_source(options)->remarks(),
              ElementsAre("the left sequence has 2 frames more than the right one: " +
                          (folder / "l/000003.png") + " to " + (folder / "l/000004.png") +
                          " have no partner"));
  EXPECT_EQ(pairs_of(options).size(), 3U);
  EXPECT_EQ(unpaired(-1), 1);
  EXPECT_EQ(unpaired(-2), 0) << "the right sequence began two frames later";
  EXPECT_EQ(unpaired(-3), 0);
  EXPECT_EQ(unpaired(1), 2) << "of the three, one is left over for the offset";
  std::swap(options.left, options.right);
  EXPECT_EQ(unpaired(0), 2);
  EXPECT_EQ(unpaired(1), 1);
  EXPECT_EQ(unpaired(2), 0);
  EXPECT_EQ(unpaired(-1), 2);
  EXPECT_THAT(open_pair_source(options)->remarks(),
              ElementsAre(HasSubstr("the right sequence has 2 frames more than the left one")));
}

TEST(PairSource, GapsInTheNumbersAreRemarked) {
  const TemporaryFolder folder;
  put_images(folder / "l", {0, 1, -1, 3, 4, 5, 6});
  put_images(folder / "r", {0, 1, -1, 3, -1, 5, 6});
  PairSourceOptions options = two_cameras(folder / "l", folder / "r");
  EXPECT_THAT(open_pair_source(options)->remarks(),
              ElementsAre("1 frame is left out without a partner (1 of the left): " +
                              (folder / "l/000004.png"),
                          "1 frame number is missing on both sides: 2"));
  EXPECT_EQ(pairs_of(options), (Values{{0, 0}, {1, 1}, {3, 3}, {5, 5}, {6, 6}}));
  expect_to_skip_everywhere(options);
  options.pair_by = PairBy::kOrder;
  EXPECT_THAT(open_pair_source(options)->remarks(),
              ElementsAre(HasSubstr("the left sequence has 1 frame more"),
                          "1 frame number is missing on both sides: 2",
                          HasSubstr("1 frame number is missing between " + (folder / "r/000000")),
                          HasSubstr("l/000004.png is paired with")));
  // In patterns a missing number is a bad frame and moves nothing.
  options = two_cameras(folder / "l/%06d.png", folder / "r/%06d.png");
  EXPECT_THAT(open_pair_source(options)->remarks(), IsEmpty());
  EXPECT_EQ(pairs_of(options), (Values{{0, 0}, {1, 1}, kBad, {3, 3}, kBad, {5, 5}, {6, 6}}));
  expect_to_skip_everywhere(options);
  // The pairs of one camera across a gap are further apart.
  EXPECT_THAT(open_pair_source(moving_camera(folder / "l"))->remarks(),
              ElementsAre(HasSubstr("1 frame number is missing")));
}

TEST(PairSource, ABadFileIsNamedAndTheNextPairFollows) {
  const TemporaryFolder folder;
  put_images(folder / "l", {0, 1, 2});
  put_images(folder / "r", {0, 1, 2});
  put_text(folder / "r/000001.png", "garbage");
  const auto source = open_pair_source(two_cameras(folder / "l", folder / "r"));
  FramePair pair;
  ASSERT_TRUE(source->fetch(pair));
  source->decode(pair);
  ASSERT_TRUE(source->fetch(pair));
  EXPECT_THAT(error_of([&] { source->decode(pair); }), HasSubstr("r/000001.png"));
  ASSERT_TRUE(source->fetch(pair));
  EXPECT_EQ(pair.index, 2);
  source->decode(pair);
  EXPECT_EQ(value_of(pair.right), 2);
  EXPECT_FALSE(source->fetch(pair));
}

TEST(PairSource, PairsAreDecodedInAnyOrder) {
  const TemporaryFolder folder;
  put_images(folder / "l", {0, 1, 2});
  put_images(folder / "r", {10, 11, 12});
  const auto source = open_pair_source(two_cameras(folder / "l", folder / "r"));
  FramePair pairs[3];
  for (FramePair& pair : pairs) {
    ASSERT_TRUE(source->fetch(pair));
  }
  for (const int i : {2, 0, 1}) {
    source->decode(pairs[i]);
    EXPECT_EQ(value_of(pairs[i].left), i);
    EXPECT_EQ(value_of(pairs[i].right), 10 + i);
  }
}

TEST(PairSource, TwoVideos) {
  const TemporaryFolder folder;
  put_video(folder / "l.mp4", counting(20, 7));
  put_video(folder / "r.mp4", counting(30, 6), {30, 1});
  PairSourceOptions options = two_cameras(folder / "l.mp4", folder / "r.mp4");
  options.offset_frames = -1;
  options.pair_by = PairBy::kOrder;
  const auto source = open_pair_source(options);
  EXPECT_EQ(source->pair_count(), 6);
  EXPECT_TRUE(source->pairing().is_whole());
  EXPECT_EQ(source->describe(2), folder / "l.mp4" + " frame 3, " + folder / "r.mp4" + " frame 2");
  EXPECT_EQ(source->frame_rate(), (FrameRate{25, 1}));
  EXPECT_EQ(source->sound().file, folder / "l.mp4");
  EXPECT_EQ(source->sound().first_frame, 1);
  EXPECT_THAT(source->remarks(), ElementsAre(HasSubstr("25 frames a second but the right one 30")));
  EXPECT_EQ(rounded(pairs_of(*source), 20, 30),
            (Values{{40, 30}, {60, 50}, {80, 70}, {100, 90}, {120, 110}, {140, 130}}));
  expect_to_skip_everywhere(options);
  // Images beside a video.
  put_images(folder / "l", {0, 1});
  const auto mixed = open_pair_source(two_cameras(folder / "l", folder / "r.mp4"));
  EXPECT_EQ(mixed->pair_count(), 2);
  EXPECT_EQ(mixed->sound().file, folder / "r.mp4");
  EXPECT_EQ(mixed->frame_rate(), (FrameRate{30, 1}));
}

TEST(PairSource, PackedImages) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "p");
  for (const int i : {0, 1, 2}) {
    Photograph packed;
    pack_stereo(plain_photograph(3, 5, i), plain_photograph(3, 5, 100 + i),
                {.layout = StereoLayout::kAboveBelow, .right_first = true}, packed);
    write_photograph(folder / ("p/" + std::to_string(i) + ".png"), packed);
  }
  PairSourceOptions options = packed_in(
      folder / "p", StereoPacking{.layout = StereoLayout::kAboveBelow, .right_first = true});
  const auto source = open_pair_source(options);
  EXPECT_EQ(source->pair_count(), 3);
  EXPECT_EQ(source->describe(2), folder / "p/2.png");
  EXPECT_EQ(pairs_of(*source), (Values{{0, 100}, {1, 101}, {2, 102}}));
  expect_to_skip_everywhere(options);
  expect_left_images_alone(options);
  put_image(folder / "p/1.png", 7);
  EXPECT_EQ(pairs_of(options), (Values{{0, 100}, kBad, {2, 102}}));
  FramePair pair;
  const auto with_bad = open_pair_source(options);
  with_bad->skip_to(1);
  ASSERT_TRUE(with_bad->fetch(pair));
  EXPECT_THAT(error_of([&] { with_bad->decode(pair); }),
              testing::AllOf(HasSubstr("p/1.png: packed image is 2x1"), HasSubstr("even height")));
  std::filesystem::remove(folder / "p/1.png");
  EXPECT_THAT(open_pair_source(options)->remarks(), IsEmpty()) << "0 and 2 may be all";
}

TEST(PairSource, PackedVideo) {
  const TemporaryFolder folder;
  VideoWriter writer(folder / "v.mp4", 64, 32, {});
  for (const int i : {0, 1, 2, 3}) {
    Photograph packed;
    pack_stereo(plain_photograph(32, 32, 20 + 20 * i), plain_photograph(32, 32, 120 + 20 * i), {},
                packed);
    writer.write(packed);
  }
  writer.finish();
  PairSourceOptions options = packed_in(folder / "v.mp4", StereoPacking{});
  const auto source = open_pair_source(options);
  EXPECT_EQ(source->frame_rate(), (FrameRate{25, 1}));
  EXPECT_EQ(source->sound().file, folder / "v.mp4");
  EXPECT_EQ(rounded(pairs_of(*source), 20, 120),
            (Values{{20, 120}, {40, 140}, {60, 160}, {80, 180}}));
  expect_to_skip_everywhere(options);
}

TEST(PairSource, ListOfPairs) {
  const TemporaryFolder folder;
  put_images(folder / "l", {0, 1, 2, 3});
  put_images(folder / "r", {100, 101, 102, 103});
  put_text(folder / "pairs.csv", "left,right\nl/000003.png,r/000001.png\nl/000000.png," +
                                     (folder / "r/000003.png") +
                                     "\nno.png,r/000000.png\nl/000001.png,r/000001.png\n");
  const PairSourceOptions options = listed_in(folder / "pairs.csv");
  const auto source = open_pair_source(options);
  EXPECT_EQ(source->pair_count(), 4);
  EXPECT_EQ(source->describe(0), folder / "l/000003.png" + ", " + folder / "r/000001.png");
  EXPECT_THAT(source->remarks(), IsEmpty()) << "whoever writes a list means it";
  const std::vector<std::string> identities = source->identities();
  EXPECT_THAT(identities, ElementsAre(HasSubstr("pairs.csv (left column): 3 files"),
                                      HasSubstr("pairs.csv (right column): 4 files")));
  EXPECT_EQ(pairs_of(*source), (Values{{3, 101}, {0, 103}, kBad, {1, 101}}));
  expect_to_skip_everywhere(options);
  put_text(folder / "pairs.csv", "l/000003.png,r/000001.png\nl/000000.png,r/000003.png\n");
  EXPECT_NE(open_pair_source(options)->identities(), identities);
  put_text(folder / "pairs.csv", "l/000003.png\n");
  EXPECT_THAT(error_of([&] { open_pair_source(options); }), HasSubstr("pairs.csv line 1: 1 field"));
}

/// Every kind of source, and the pairs that --every takes of it.
TEST(PairSource, EveryNthPair) {
  const TemporaryFolder folder;
  put_images(folder / "l", {0, 1, 2, 3, 4, 5, 6});
  put_images(folder / "r", {100, 101, 102, 103, 104, 105, 106});
  put_video(folder / "l.mp4", counting(20, 7));
  put_video(folder / "r.mp4", counting(30, 7));
  put_text(folder / "list.csv",
           "l/000000.png,r/000001.png\nl/000001.png,r/000002.png\n"
           "l/000002.png,r/000003.png\nl/000003.png,r/000004.png\n");
  for (PairSourceOptions options :
       {two_cameras(folder / "l", folder / "r", -1),
        two_cameras(folder / "l.mp4", folder / "r.mp4"), listed_in(folder / "list.csv"),
        moving_camera(folder / "r", 2), moving_camera(folder / "r.mp4", -1)}) {
    const Values all = pairs_of(options);
    for (const int step : {2, 3, 50}) {
      for (const int first : {0, 1}) {
        Values expected;
        for (std::size_t i = static_cast<std::size_t>(first); i < all.size();
             i += static_cast<std::size_t>(step)) {
          expected.push_back(all[i]);
        }
        options.every = {.pairs = step, .first = first, .seconds = std::nullopt};
        EXPECT_EQ(pairs_of(options), expected) << step << " " << first;
        EXPECT_EQ(open_pair_source(options)->pair_count(), static_cast<int>(expected.size()));
        EXPECT_EQ(open_pair_source(options)->describe(0), [&] {
          PairSourceOptions whole = options;
          whole.every = {};
          return open_pair_source(whole)->describe(first);
        }());
      }
    }
  }
}

TEST(PairSource, EveryNthPairKeepsTimeAndNumbers) {
  const TemporaryFolder folder;
  put_images(folder / "l", {0, 1, 2, 3, 4, 5, 6});
  put_video(folder / "l.mp4", counting(20, 7));
  PairSourceOptions options = two_cameras(folder / "l.mp4", folder / "l.mp4");
  const FrameRate rate = open_pair_source(options)->frame_rate().value();
  options.every.seconds = 3 / rate.per_second();
  options.every.first = 1;
  const auto source = open_pair_source(options);
  EXPECT_EQ(source->pair_count(), 2);  // 1 and 4
  EXPECT_EQ(source->frame_rate(), slowed_down(rate, 3));
  EXPECT_DOUBLE_EQ(source->sound().first_frame, 1.0 / 3);
  EXPECT_EQ(source->pairs_of({0, 7}), (FrameRange{0, 2}));
  EXPECT_EQ(source->pairs_of({1, 2}), (FrameRange{0, 1}));
  EXPECT_EQ(source->pairs_of({2, 4}), (FrameRange{1, 1}));
  EXPECT_EQ(source->pairs_of({2, 100}), (FrameRange{1, 2}));
  options.every.first = 7;
  EXPECT_THAT(error_of([&] { open_pair_source(options); }), HasSubstr("from frame 7 on"));
  options.every.first = 0;
  options.left = options.right = folder / "l";
  EXPECT_THAT(error_of([&] { open_pair_source(options); }), HasSubstr("no frame rate"));
}

TEST(PairSource, OneMovingCameraFromImages) {
  const TemporaryFolder folder;
  put_images(folder / "s", {0, 1, 2, 3, 4});
  PairSourceOptions options = moving_camera(folder / "s");
  EXPECT_EQ(pairs_of(options), (Values{{0, 1}, {1, 2}, {2, 3}, {3, 4}}));
  options.step = 3;
  EXPECT_EQ(pairs_of(options), (Values{{0, 3}, {1, 4}}));
  options.step = -2;
  EXPECT_EQ(pairs_of(options), (Values{{2, 0}, {3, 1}, {4, 2}}));
  EXPECT_EQ(open_pair_source(options)->describe(1),
            folder / "s/000003.png" + ", " + folder / "s/000001.png");
  EXPECT_TRUE(open_pair_source(options)->pairing().is_whole());
  expect_to_skip_everywhere(options);
  put_text(folder / "s/000002.png", "garbage");
  EXPECT_EQ(pairs_of(options), (Values{kBad, {3, 1}, kBad}));
  options.step = 5;
  EXPECT_THAT(error_of([&] { open_pair_source(options); }),
              HasSubstr("no frame has a partner: the sequence has 5 frames, the step is 5"));
}

TEST(PairSource, OneMovingCameraFromAVideo) {
  const TemporaryFolder folder;
  put_video(folder / "v.mp4", counting(20, 7));
  for (const int step : {1, -1, 2, -3, 6}) {
    const PairSourceOptions options = moving_camera(folder / "v.mp4", step);
    Values expected;
    for (int t = std::max(0, -step); t < 7 - std::max(0, step); ++t) {
      expected.emplace_back(20 + 20 * t, 20 + 20 * (t + step));
    }
    EXPECT_EQ(rounded(pairs_of(options), 20, 20), expected) << step;
    EXPECT_EQ(open_pair_source(options)->sound().first_frame, std::max(0, -step));
    EXPECT_EQ(open_pair_source(options)->frames_kept(), std::abs(step) + 1);
    expect_to_skip_everywhere(options);
  }
}

TEST(PairSource, FramesOfAMovingCameraDoNotShareMemory) {
  const TemporaryFolder folder;
  put_video(folder / "v.mp4", counting(20, 6));
  const auto source = open_pair_source(moving_camera(folder / "v.mp4"));
  FramePair pairs[5];
  for (FramePair& pair : pairs) {
    ASSERT_TRUE(source->fetch(pair));
  }
  for (const int i : {4, 0, 3, 1, 2}) {
    source->decode(pairs[i]);
    EXPECT_NEAR(value_of(pairs[i].left), 20 + 20 * i, 4);
    EXPECT_NEAR(value_of(pairs[i].right), 40 + 20 * i, 4);
    std::get<Image<std::uint8_t>>(pairs[i].left.pixels).fill(0);
    std::get<Image<std::uint8_t>>(pairs[i].right.pixels).fill(0);
  }
}

TEST(PairSource, OptionsAreChecked) {
  const auto refuse = [](const PairSourceOptions& options, const char* expected) {
    EXPECT_THAT(error_of([&] { options.validate(); }), HasSubstr(expected));
    EXPECT_THROW(options.validate(), UsageError) << expected;
  };
  refuse({}, "no input is given");
  refuse(two_cameras("l", ""), "left is given without right");
  refuse(two_cameras("", "r"), "right is given without left");
  PairSourceOptions both = two_cameras("l", "r");
  both.pairs = "p";
  refuse(both, "several kinds of input are given");
  PairSourceOptions packed = packed_in("s", {});
  packed.stereo = "-";
  packed.packing.reset();
  refuse(packed, "`stereo` needs `packing`, such as sbsl");
  PairSourceOptions not_packed = two_cameras("l", "r");
  not_packed.packing = StereoPacking{};
  refuse(not_packed, "packing is given without stereo");
  refuse(two_cameras("l", "r", 1000001), "offset is 1000001");
  refuse(two_cameras("l", "r", -1000001), "offset is -1000001");
  PairSourceOptions listed = listed_in("p");
  listed.offset_frames = 1;
  refuse(listed, "offset is 1, expected 0 without left and right");
  listed.offset_frames = 0;
  listed.step = 2;
  refuse(listed, "step is 2, expected 1 without sequence");
  refuse(moving_camera("s", 0), "step is 0, expected 1 to 1000 frames or -1 to -1000");
  refuse(moving_camera("s", -1001), "step is -1001");
  EXPECT_NO_THROW(moving_camera("s", -1000).validate());
  refuse(two_cameras("tcp://h:1", "tcp://h:1"), "left and right are the same stream");
  PairSourceOptions stream = two_cameras("tcp://h:1", "tcp://h:2");
  PairSourceOptions list = listed_in("p");
  list.pair_by = stream.pair_by = PairBy::kName;
  refuse(stream, "pair-by is given, expected it with files");
  refuse(list, "pair-by is given, expected it with files");
  list.pair_by.reset();
  list.more = stream.more = {"m"};
  refuse(stream, "more is given and left is a stream, expected files");
  refuse(list, "more is given, expected it with left and right only");
  PairSourceOptions late = two_cameras("l", "r");
  late.every.first = std::numeric_limits<int>::max();
  refuse(late, "every starts at frame 2147483647, expected 0 to");
  PairSourceOptions supplied;
  supplied.queue = std::make_shared<PairQueue>(1);
  supplied.every.pairs = 2;
  refuse(supplied, "every is given, expected it with files only: supply the pairs to take");
}

/// Real frames, as files and packed into a video.
TEST(PairSource, FilesAndAPackedVideoOfOneDrive) {
  const std::filesystem::path data = test_paths::shared_data() / "kitti_seq1";
  if (!std::filesystem::exists(data)) {
    GTEST_SKIP() << "no " << data;
  }
  const auto files = open_pair_source(two_cameras(data / "left", data / "right"));
  EXPECT_EQ(files->pair_count(), 36);
  EXPECT_THAT(files->remarks(), IsEmpty());
  PairSourceOptions options = packed_in(data / "kitti_seq1_sbs.mp4", StereoPacking{});
  const auto video = open_pair_source(options);
  EXPECT_EQ(video->pair_count(), 51);
  FramePair of_files;
  FramePair of_video;
  files->skip_to(20);
  video->skip_to(20);
  ASSERT_TRUE(files->fetch(of_files) && video->fetch(of_video));
  files->decode(of_files);
  video->decode(of_video);
  EXPECT_EQ(of_video.left.width(), of_files.left.width());
  EXPECT_EQ(of_video.right.height(), of_files.right.height());
}

}  // namespace vantage::pair_source_test
