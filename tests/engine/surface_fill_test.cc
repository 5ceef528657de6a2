#include "engine/refinement/surface_fill.h"

#include "engine/refinement/refine_maps.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/every_execution.h"

namespace vantage::surface_fill_test {

constexpr int kWidth = 203;
constexpr int kHeight = 101;
constexpr DisparityRange kSearch{0, 40};

/// A slanted wall of one colour, before it a card of another from column 90 to 129 of the left
/// image.
struct WallWithCard {
  double wall_px = 6;
  double slope_x = 0.03;
  double slope_y = 0.05;
  double card_px = 30;

  [[nodiscard]] double wall_at(double x, double y) const {
    return wall_px + slope_x * x + slope_y * y;
  }
  [[nodiscard]] bool is_card(double x, double y) const {
    return x >= 90 && x < 130 && y >= 20 && y < 80;
  }
  /// Of the left image.
  [[nodiscard]] double at(double x, double y) const {
    return is_card(x, y) ? card_px : wall_at(x, y);
  }
};

/// Its maps as a matcher leaves them: true where both cameras see a pixel, elsewhere nonsense.
struct Matched {
  Photograph photograph;
  MatchedMap left;
  MatchedMap right;
};

Matched matched_maps(const WallWithCard& scene) {
  Image<std::uint8_t> pixels(kWidth, kHeight, 3);
  Matched maps;
  maps.left.disparity_px = DisparityMap(kWidth, kHeight);
  maps.right.disparity_px = DisparityMap(kWidth, kHeight);
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    const std::uint8_t level = scene.is_card(x, y) ? 40 : 160;
    for (int c = 0; c < 3; ++c) {
      pixels.at(x, y, c) = level;
    }
    maps.left.disparity_px.at(x, y) = static_cast<float>(scene.at(x, y));
    // The wall of the right image: column x shows wall_at(x + d), which is linear.
    const double wall_px = (scene.wall_at(x, y)) / (1 - scene.slope_x);
    const bool is_card = scene.is_card(x + scene.card_px, y);
    maps.right.disparity_px.at(x, y) = static_cast<float>(is_card ? scene.card_px : wall_px);
  }
  // What the card hides from the right camera, and what lies outside its image.
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    const double partner = x - scene.at(x, y);
    const bool is_hidden = !scene.is_card(x, y) && scene.is_card(partner + scene.card_px, y);
    if (is_hidden || partner < 0) {
      maps.left.disparity_px.at(x, y) = 37;
    }
  }
  maps.photograph = Photograph{std::move(pixels)};
  return maps;
}

DisparityMap refined(const WallWithCard& scene, Fill fill, bool right_is_result = true) {
  Matched maps = matched_maps(scene);
  RefinementWork work;
  const MapToRefine left{
      .side = Side::kLeft, .image = &maps.photograph, .map = &maps.left, .search = kSearch};
  const MapToRefine right{.side = Side::kRight,
                          .image = &maps.photograph,
                          .map = &maps.right,
                          .is_result = right_is_result,
                          .search = kSearch};
  refine_maps({.cross_check_px = 1, .fill = fill}, left, &right, execution(), work,
              [](std::string_view) {});
  return std::move(maps.left.disparity_px);
}

/// Pixels of the wall beside the card that are wrong by more than half a pixel.
int wrong_pixels(const WallWithCard& scene, const DisparityMap& map_px) {
  int wrong = 0;
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    wrong += std::abs(map_px.at(x, y) - scene.at(x, y)) > 0.5 ? 1 : 0;
  }
  return wrong;
}

TEST(SurfaceFill, HiddenPixelsContinueTheSlantOfTheWall) {
  for (const double slope_x : {0.06, -0.05}) {
    const WallWithCard scene{.wall_px = 12, .slope_x = slope_x};
    const int before = wrong_pixels(scene, refined(scene, Fill::kMedian));
    const int after = wrong_pixels(scene, refined(scene, Fill::kSurfaces));
    EXPECT_GT(before, 500) << slope_x;
    EXPECT_LT(after, before / 10) << slope_x;
  }
}

TEST(SurfaceFill, TheOtherMapNeedNotBeAResult) {
  const WallWithCard scene{};
  EXPECT_TRUE(
      identical(refined(scene, Fill::kSurfaces, true), refined(scene, Fill::kSurfaces, false)));
}

/// Maps in which every unmatched pixel has the value 37, and a row of the other map.
struct Plain {
  Photograph photograph;
  DisparityMap map_px{kWidth, kHeight};
  Mask unmatched{kWidth, kHeight};
  DisparityMap other_px{kWidth, kHeight};
  OtherCameraView other;
  FilledMediansWork medians;

  template <typename MapAt, typename OtherAt>
  Plain(const MapAt& map_at, const OtherAt& other_at) {
    Image<std::uint8_t> grey(kWidth, kHeight, 1);
    grey.fill(90);
    photograph = Photograph{std::move(grey)};
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      unmatched.at(x, y) = x >= 100 && x < 120 ? 255 : 0;
      map_px.at(x, y) = unmatched.at(x, y) != 0 ? 37 : map_at(x, y);
      other_px.at(x, y) = other_at(x, y);
    }
    other.map_px = std::as_const(other_px).view();
    other.matched.resize((kWidth + 63) / 64, kHeight);
    other.matched.fill(~std::uint64_t{0});
    frame_photograph(photograph, execution(), medians);
  }

  DisparityMap filled(Execution& execution = vantage::execution()) {
    DisparityMap result = map_px.copy();
    SurfaceFillWork work;
    fill_by_surfaces(unmatched, other, medians, kSearch, execution, work, result);
    return result;
  }
};

TEST(SurfaceFill, ValuesStayWhereTheOtherCameraSeesNoReason) {
  const auto wall = [](int /*x*/, int y) { return 10 + 0.02F * static_cast<float>(y); };
  // The other camera sees the wall where it would lie, and nothing behind the value of the fill.
  Plain consistent(wall,
                   [](int x, int y) { return x < 85 ? 37 : 10 + 0.02F * static_cast<float>(y); });
  EXPECT_TRUE(identical(consistent.filled(), consistent.map_px));
  // It sees the wall through that value.
  Plain seen_through(wall, wall);
  // Something nearer hides the wall.
  Plain hidden(wall, [](int /*x*/, int /*y*/) { return 30.0F; });
  for (Plain* plain : {&seen_through, &hidden}) {
    const DisparityMap filled = plain->filled();
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      ASSERT_NEAR(filled.at(x, y), wall(x, y), 0.02) << x << ", " << y;
    }
  }
}

TEST(SurfaceFill, ValuesStayWhereSurfacesDisagree) {
  Plain noise([&](int x, int y) { return static_cast<float>((x / 8 * 7 + y / 8 * 5) % 12 * 3); },
              [](int /*x*/, int /*y*/) { return 39.0F; });
  EXPECT_TRUE(identical(noise.filled(), noise.map_px));
}

TEST(SurfaceFill, IdenticalForAnyExecution) {
  const auto wall = [](int x, int y) {
    return 9 + 0.03F * static_cast<float>(x % 60) + 0.02F * static_cast<float>(y);
  };
  Plain plain(wall, [](int x, int y) { return static_cast<float>((x + y) % 31); });
  EXPECT_FALSE(identical(plain.filled(), plain.map_px));
  expect_equal_for_every_execution(
      [&](Execution& other) { return values_of(plain.filled(other)); });
}

TEST(SurfaceFill, SmallMapsAreTaken) {
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 9}, {9, 3}, {17, 8}}) {
    DisparityMap map_px(width, height);
    Mask unmatched(width, height);
    DisparityMap other_px(width, height);
    Image<std::uint8_t> grey(width, height, 1);
    map_px.fill(4);
    other_px.fill(30);
    unmatched.fill(0);
    grey.fill(7);
    unmatched.at(width - 1, height - 1) = 255;
    OtherCameraView other;
    other.map_px = std::as_const(other_px).view();
    other.matched.resize(1, height);
    other.matched.fill(0);
    FilledMediansWork medians;
    frame_photograph(Photograph{std::move(grey)}, execution(), medians);
    SurfaceFillWork work;
    fill_by_surfaces(unmatched, other, medians, kSearch, execution(), work, map_px);
    for (const auto [x, y] : positions_of(width, height)) {
      EXPECT_EQ(map_px.at(x, y), 4);
    }
  }
}

}  // namespace vantage::surface_fill_test
