#include "engine/refinement/occlusion_consistency.h"

#include "engine/refinement/refine_maps.h"
#include "kernels/filled_median/filled_median.h"
#include "tests/engine/engine_test.h"

namespace vantage::occlusion_consistency_test {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

struct Case {
  Image<std::uint8_t> photograph;
  DisparityMap map_px;
  Mask unmatched;
  DisparityMap other_px;
  Mask is_matched;
  OtherCameraView other;
};

/// Steps of some pixels' length, with unknown pixels in the other map.
Case random_case(int width, int height, Side side, int pixels_per_column) {
  Case result{.photograph = Image<std::uint8_t>(width, height, 3),
              .map_px = DisparityMap(width, height),
              .unmatched = Mask(width, height),
              .other_px = DisparityMap(width, height),
              .is_matched = Mask(width, height),
              .other = {}};
  result.other.side = side;
  result.other.columns_per_px = 1.0F / static_cast<float>(pixels_per_column);
  std::mt19937 random(41);
  float level = 0;
  float other_level = 0;
  for (const auto [x, y] : positions_of(width, height)) {
    level = random() % 9 == 0 ? static_cast<float>(random() % 12) : level;
    other_level = random() % 9 == 0 ? static_cast<float>(random() % 12) : other_level;
    result.map_px.at(x, y) = level + static_cast<float>(random() % 4) / 4;
    result.other_px.at(x, y) = random() % 90 == 0 ? kUnknown : other_level;
    result.is_matched.at(x, y) = random() % 60 == 0 ? 0 : 255;
    result.unmatched.at(x, y) = random() % 3 == 0 ? 0 : 255;
    for (int c = 0; c < 3; ++c) {
      result.photograph.at(x, y, c) = static_cast<std::uint8_t>(100 + random() % 60);
    }
  }
  result.other.matched.resize((width + 63) / 64, height);
  result.other.matched.fill(0);
  for (const auto [x, y] : positions_of(width, height)) {
    result.other.matched.at(x / 64, y) |= std::uint64_t{result.is_matched.at(x, y) != 0} << x % 64;
  }
  return result;
}

/// EQUATIONS §5.7.
bool contradicts(const Case& c, int x, int y, double px) {
  const int width = c.other_px.width();
  const int direction = c.other.side == Side::kLeft ? -1 : 1;
  const double partner = std::floor(x + direction * double{c.other.columns_per_px} * px + 0.5);
  if (partner < 0 || partner >= width) {
    return false;
  }
  for (int beside = -1; beside <= 1; ++beside) {
    const int column = std::clamp(static_cast<int>(partner) + beside, 0, width - 1);
    if (c.is_matched.at(column, y) == 0 || !(c.other_px.at(column, y) < px - 1)) {
      return false;
    }
  }
  return true;
}

DisparityMap mended_plainly(const Case& c, int step, int& contradicted) {
  DisparityMap result = c.map_px.copy();
  const auto is_contradicted = [&](int x, int y) {
    return c.unmatched.at(x, y) != 0 && contradicts(c, x, y, c.map_px.at(x, y));
  };
  for (const auto [x, y] : positions_of(c.map_px.width(), c.map_px.height())) {
    if (!is_contradicted(x, y)) {
      continue;
    }
    ++contradicted;
    std::map<float, double> weights;
    double total = 0;
    for (const auto [i, j] : positions_of(7, 7)) {
      const int column = x + (i - 3) * step;
      const int row = y + (j - 3) * step;
      if (column < 0 || row < 0 || column >= c.map_px.width() || row >= c.map_px.height() ||
          is_contradicted(column, row) || contradicts(c, x, y, c.map_px.at(column, row))) {
        continue;
      }
      std::size_t difference = 0;
      for (int k = 0; k < 3; ++k) {
        difference += static_cast<std::size_t>(
            std::abs(c.photograph.at(x, y, k) - c.photograph.at(column, row, k)));
      }
      const double weight = kernels::filled_median_weights()[difference];
      weights[c.map_px.at(column, row)] += weight;
      total += weight;
    }
    double sum = 0;
    for (const auto& [px, weight] : weights) {
      sum += weight;
      if (weight > 0 && 2 * sum >= total) {
        result.at(x, y) = px;
        break;
      }
    }
  }
  return result;
}

TEST(OcclusionConsistency, EqualsItsDefinition) {
  for (const int pixels_per_column : {1, 2}) {
    for (const Side side : {Side::kLeft, Side::kRight}) {
      Case c = random_case(67, 23, side, pixels_per_column);
      int contradicted = 0;
      const DisparityMap expected = mended_plainly(c, 6 / pixels_per_column, contradicted);
      EXPECT_GT(contradicted, 100);
      FilledMediansWork medians;
      Mask nothing(67, 23);
      nothing.fill(0);
      take_filled_medians(nothing, Photograph{c.photograph.copy()}, {}, execution(), medians,
                          c.map_px);
      Mask work;
      c.other.map_px = std::as_const(c.other_px).view();
      mend_contradicted(c.unmatched, c.other, medians, execution(), work, c.map_px);
      EXPECT_TRUE(identical(c.map_px, expected));
    }
  }
}

// A pole and a square at disparity 8 before a wall at 2. The left map has grown over the wall
// between them; the right camera sees it there, and the wall left of the pole in both images
// confirms it.
TEST(OcclusionConsistency, ForegroundDoesNotGrowOverWhatTheOtherCameraSees) {
  constexpr int kWidth = 70;
  constexpr int kHeight = 40;
  Image<std::uint8_t> grey(kWidth, kHeight, 1);
  grey.fill(90);
  const Photograph photograph{std::move(grey)};
  const auto refined = [&](Fill fill, bool right_is_result) {
    MatchedMap left{.disparity_px = DisparityMap(kWidth, kHeight)};
    MatchedMap right{.disparity_px = DisparityMap(kWidth, kHeight)};
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      const bool is_wall = y < 8 || y >= 32;
      const bool is_right_wall = x < 22 || x == std::clamp(x, 24, 29) || x >= 42;
      left.disparity_px.at(x, y) = is_wall || x < 30 || x >= 50 ? 2.0F : 8.0F;
      right.disparity_px.at(x, y) = is_wall || is_right_wall ? 2.0F : 8.0F;
    }
    RefinementWork work;
    const MapToRefine of_left{.side = Side::kLeft, .image = &photograph, .map = &left};
    const MapToRefine of_right{
        .side = Side::kRight, .image = &photograph, .map = &right, .is_result = right_is_result};
    refine_maps({.cross_check_px = 1, .fill = fill}, of_left, &of_right, execution(), work,
                [](std::string_view) {});
    return std::move(left.disparity_px);
  };
  const DisparityMap mended = refined(Fill::kFarther, true);
  EXPECT_TRUE(identical(mended, refined(Fill::kFarther, false)));
  for (int y = 18; y < 22; ++y) {
    for (const auto& [x, px] : std::map<int, float>{{29, 2}, {31, 8}, {33, 2}, {34, 2}, {40, 8}}) {
      EXPECT_EQ(mended.at(x, y), px) << x << ", " << y;
    }
    EXPECT_EQ(refined(Fill::kPlanes, true).at(33, y), 8);
  }
}

}  // namespace vantage::occlusion_consistency_test
