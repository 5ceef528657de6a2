#include "engine/matching/search/reduced/reduction.h"

#include "engine/matching/stereo_matcher.h"
#include "tests/engine/engine_test.h"

namespace vantage::reduced_matcher_test {

struct PhotographPair {
  Photograph left;
  Photograph right;
};

/// Random texture, smooth over about three pixels, displaced by `shift_px`; `near_px` more in a
/// rectangle in the middle.
PhotographPair shifted_pair(int width, int height, int shift_px, int near_px, int channels = 1) {
  std::mt19937 random(4);
  Image<float> noise(width + 400, height);
  for (int y = 0; y < height; ++y) {
    float value = 0;
    for (int x = 0; x < noise.width(); ++x) {
      value = 0.5F * value + 0.5F * static_cast<float>(random() % 256);
      noise.at(x, y) = value;
    }
  }
  Image<std::uint8_t> left(width, height, channels);
  Image<std::uint8_t> right(width, height, channels);
  const auto is_near = [&](int x, int y) {
    return x > width / 3 && x < 2 * width / 3 && y > height / 3 && y < 2 * height / 3;
  };
  for (const auto [x, y] : positions_of(width, height)) {
    for (int c = 0; c < channels; ++c) {
      left.at(x, y, c) = static_cast<std::uint8_t>(noise.at(x + 200, y));
      const int from = is_near(x + shift_px + near_px, y) ? x + shift_px + near_px : x + shift_px;
      right.at(x, y, c) = static_cast<std::uint8_t>(noise.at(from + 200, y));
    }
  }
  return {{std::move(left)}, {std::move(right)}};
}

MatchOptions realtime(DisparityRange range) {
  MatchOptions options;
  options.preset = MatchPreset::kRealtime;
  options.disparities = range;
  return options;
}

/// Share of pixels of the left map within a pixel of the truth, borders and outlines aside.
double share_right(const DisparityMap& map, int shift_px, int near_px) {
  int right = 0;
  int all = 0;
  const int w = map.width();
  const int h = map.height();
  for (const auto [x, y] : positions_of({shift_px + near_px + 8, w - 8}, {8, h - 8})) {
    const bool is_near = x > w / 3 + 8 && x < 2 * w / 3 - 8 && y > h / 3 + 8 && y < 2 * h / 3 - 8;
    const bool is_far =
        x < w / 3 - 8 - near_px || x > 2 * w / 3 + 8 || y < h / 3 - 8 || y > 2 * h / 3 + 8;
    if (is_near || is_far) {
      ++all;
      right += std::abs(map.at(x, y) - static_cast<float>(shift_px + (is_near ? near_px : 0))) < 1
                   ? 1
                   : 0;
    }
  }
  return static_cast<double>(right) / all;
}

TEST(ReducedMatcher, FindsTwoSurfacesAtEverySearchSize) {
  const PhotographPair pair = shifted_pair(241, 163, 11, 9, 3);
  for (const SearchSize size :
       {SearchSize::kFull, SearchSize::kHalf, SearchSize::kQuarter, SearchSize::kAuto}) {
    MatchOptions options = realtime({0, 40});
    options.parameters.search_size = size;
    DisparityMaps maps;
    StereoMatcher(options, execution()).match(pair.left, pair.right, {}, maps);
    EXPECT_GT(share_right(maps.left.disparity_px, 11, 9), 0.98) << static_cast<int>(size);
    EXPECT_EQ(maps.right.disparity_px.width(), 241);
    EXPECT_EQ(maps.right.unmatched.height(), 163);
  }
}

TEST(ReducedMatcher, MapsAreTheSameForAnyExecutionAndRequest) {
  const PhotographPair pair = shifted_pair(131, 99, 9, 14);
  for (const SearchSize size : {SearchSize::kHalf, SearchSize::kQuarter}) {
    MatchOptions options = realtime({-5, 33});
    options.parameters.search_size = size;
    Execution one({.threads = 1, .executor = scheduler::ExecutorKind::kSerial});
    DisparityMaps expected;
    StereoMatcher(options, one).match(pair.left, pair.right, {.confidence = true}, expected);
    for (const auto [x, y] : positions_of(131, 99)) {
      const float confidence = expected.left.confidence.at(x, y);
      ASSERT_TRUE(std::isnan(confidence) || (confidence > 0 && confidence <= 1));
    }
    for (const ExecutionOptions& how :
         {ExecutionOptions{.threads = 3},
          {.threads = 2, .strip_width_px = 11},
          {.threads = 2, .band_height_px = 3, .iterations_per_pass = 1}}) {
      Execution execution(how);
      const StereoMatcher matcher(options, execution);
      DisparityMaps maps;
      for (int again = 0; again < 2; ++again) {
        matcher.match(pair.left, pair.right, {.confidence = true}, maps);
        EXPECT_TRUE(identical(maps, expected));
        EXPECT_TRUE(identical(maps.left.unmatched, expected.left.unmatched));
      }
      DisparityMaps left;
      matcher.match(pair.left, pair.right, {.right = false}, left);
      EXPECT_TRUE(identical(left.left.disparity_px, expected.left.disparity_px));
      EXPECT_TRUE(left.right.disparity_px.empty());
      DisparityMaps right;
      matcher.match(pair.left, pair.right, {.left = false}, right);
      EXPECT_TRUE(identical(right.right.disparity_px, expected.right.disparity_px));
    }
  }
}

TEST(ReducedMatcher, ReductionsDependOnCandidatesAndSize) {
  const auto reductions = [](int candidates, scheduler::Extent extent) {
    return search_reductions(realtime({0, candidates - 1}).in_force(), extent);
  };
  EXPECT_EQ(reductions(16, {640, 480}), 0);
  EXPECT_EQ(reductions(17, {640, 480}), 1);
  EXPECT_EQ(reductions(128, {640, 480}), 1);
  EXPECT_EQ(reductions(129, {640, 480}), 2);
  EXPECT_EQ(reductions(4096, {9000, 480}), 2);
  EXPECT_EQ(reductions(129, {640, 63}), 1);
  EXPECT_EQ(reductions(64, {31, 480}), 0);
}

TEST(ReducedMatcher, SmallImagesAndFewCandidatesWork) {
  for (const auto& [width, height] : {std::pair{1, 1}, {33, 32}, {64, 33}, {35, 70}}) {
    const PhotographPair pair = shifted_pair(width, height, 2, 0);
    for (const DisparityRange range : {DisparityRange{0, 0}, {-3, 1}, {-40, 300}}) {
      for (const SearchSize size : {SearchSize::kHalf, SearchSize::kQuarter}) {
        MatchOptions options = realtime(range);
        options.parameters.search_size = size;
        DisparityMaps maps;
        StereoMatcher(options, execution()).match(pair.left, pair.right, {}, maps);
        ASSERT_EQ(maps.left.disparity_px.width(), width);
        for (const auto [x, y] : positions_of(width, height)) {
          const float disparity_px = maps.left.disparity_px.at(x, y);
          ASSERT_TRUE(std::isnan(disparity_px) || (disparity_px >= static_cast<float>(range.min) &&
                                                   disparity_px <= static_cast<float>(range.max)));
        }
      }
    }
  }
}

TEST(ReducedMatcher, RawMapsAreWinnersEnlarged) {
  const PhotographPair pair = shifted_pair(120, 90, 10, 0);
  MatchOptions options = realtime({0, 31});
  options.raw = true;
  DisparityMaps maps;
  StereoMatcher(options, execution()).match(pair.left, pair.right, {}, maps);
  EXPECT_GT(share_right(maps.left.disparity_px, 10, 0), 0.98);
}

TEST(ReducedMatcher, RefusesPriorsAndRangesOutsideTheImage) {
  const PhotographPair pair = shifted_pair(64, 64, 2, 0);
  DisparityMaps maps;
  const StereoMatcher matcher(realtime({0, 31}), execution());
  const DisparityMap prior(64, 64);
  EXPECT_THROW(matcher.match(pair.left, pair.right, {.prior = {.left_px = prior.view()}}, maps),
               UsageError);
  EXPECT_THROW(
      StereoMatcher(realtime({100, 131}), execution()).match(pair.left, pair.right, {}, maps),
      Error);
}

}  // namespace vantage::reduced_matcher_test
