#include "engine/refinement/border_planes.h"

#include "engine/refinement/refine_maps.h"
#include "tests/engine/engine_test.h"

namespace vantage::border_planes_test {

constexpr int kWidth = 131;
constexpr int kHeight = 77;
constexpr DisparityRange kSearch{0, 60};

float slanted_px(int x, int y) {
  return 21.25F + 0.11F * static_cast<float>(x) - 0.07F * static_cast<float>(y);
}

/// A left map of which the right camera sees the pixels x ≥ d, and 12 more columns are unmatched in
/// every fifth row. `surface_px` is the truth.
template <typename Surface>
MatchedMap banded_map(const Surface& surface_px) {
  MatchedMap map{.disparity_px = DisparityMap(kWidth, kHeight), .unmatched = Mask(kWidth, kHeight)};
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    const float d = surface_px(x, y);
    const bool is_matched = static_cast<float>(x) >= d + (y % 5 == 0 ? 12 : 0);
    map.disparity_px.at(x, y) = is_matched ? d : -7;
    map.unmatched.at(x, y) = is_matched ? 0 : 255;
  }
  return map;
}

TEST(BorderPlanes, ContinueTheSlantIntoTheBandAndNoFurther) {
  MatchedMap map = banded_map(slanted_px);
  fill_border_planes(map.unmatched, Side::kLeft, 1, kSearch, execution(), map.disparity_px);
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    const float d = slanted_px(x, y);
    const bool is_in_band = static_cast<float>(x) < d;
    const bool is_kept = !is_in_band && map.unmatched.at(x, y) != 0;
    ASSERT_NEAR(map.disparity_px.at(x, y), is_kept ? -7 : d, 1e-3) << x << ", " << y;
  }
}

TEST(BorderPlanes, MirroredMapsGiveMirroredBands) {
  MatchedMap left = banded_map(slanted_px);
  MatchedMap right{.disparity_px = DisparityMap(kWidth, kHeight),
                   .unmatched = Mask(kWidth, kHeight)};
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    right.disparity_px.at(x, y) = left.disparity_px.at(kWidth - 1 - x, y);
    right.unmatched.at(x, y) = left.unmatched.at(kWidth - 1 - x, y);
  }
  fill_border_planes(left.unmatched, Side::kLeft, 1, kSearch, execution(), left.disparity_px);
  fill_border_planes(right.unmatched, Side::kRight, 1, kSearch, execution(), right.disparity_px);
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    ASSERT_EQ(right.disparity_px.at(x, y), left.disparity_px.at(kWidth - 1 - x, y));
  }
}

TEST(BorderPlanes, WhatIsNoPlaneKeepsItsFill) {
  std::mt19937 random(5);
  MatchedMap map = banded_map(
      [&](int /*x*/, int /*y*/) { return 15 + 0.01F * static_cast<float>(random() % 1200); });
  const DisparityMap before = map.disparity_px.copy();
  fill_border_planes(map.unmatched, Side::kLeft, 1, kSearch, execution(), map.disparity_px);
  EXPECT_TRUE(identical(map.disparity_px, before));
}

TEST(BorderPlanes, RefinementTakesThemBeforeTheMedians) {
  Image<std::uint8_t> grey(kWidth, kHeight, 1);
  grey.fill(90);
  const Photograph photograph{std::move(grey)};
  RefinementWork work;
  const auto refined = [&](Fill fill) {
    MatchedMap matched = banded_map(slanted_px);
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      if (matched.unmatched.at(x, y) != 0) {
        matched.disparity_px.at(x, y) = std::nanf("");
      }
    }
    const MapToRefine map{
        .side = Side::kLeft, .image = &photograph, .map = &matched, .search = kSearch};
    refine_maps({.cross_check = false, .fill = fill}, map, nullptr, execution(), work,
                [](std::string_view) {});
    return std::move(matched.disparity_px);
  };
  const MatchedMap banded = banded_map(slanted_px);
  DisparityMap expected = refined(Fill::kConstant);
  fill_border_planes(banded.unmatched, Side::kLeft, 1, kSearch, execution(), expected);
  FilledMediansWork medians;
  frame_photograph(photograph, execution(), medians);
  take_filled_medians(banded.unmatched, {}, execution(), medians, expected);
  const DisparityMap planes = refined(Fill::kPlanes);
  EXPECT_TRUE(identical(planes, expected));
  EXPECT_FALSE(identical(planes, refined(Fill::kMedian)));
}

}  // namespace vantage::border_planes_test
