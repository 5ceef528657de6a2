#include "engine/refinement/surface_fit.h"

#include "engine/refinement/refine_maps.h"
#include "tests/engine/engine_test.h"

namespace vantage::surface_fit_test {

/// The search range of all maps in this file.
constexpr DisparityRange kSearch{-40, 60};

float plane(int x, int y) {
  return 8 + 0.12F * static_cast<float>(x) - 0.07F * static_cast<float>(y);
}

/// Winners of a slanted plane, each fifth pixel unmatched: far off or unknown.
struct SteppedMap {
  DisparityMap map;
  Mask unmatched;
};

SteppedMap stepped_map(int width, int height) {
  std::mt19937 random(61);
  SteppedMap result{DisparityMap(width, height), Mask(width, height)};
  for (const auto [x, y] : positions_of(width, height)) {
    const bool is_unmatched = random() % 5 == 0;
    const float stray = random() % 2 == 0 ? kUnknown : std::round(plane(x, y)) + 1;
    result.map.at(x, y) = is_unmatched ? stray : std::round(plane(x, y));
    result.unmatched.at(x, y) = is_unmatched ? 255 : 0;
  }
  return result;
}

TEST(FitSurface, OnlyMatchedPixelsCountAndChange) {
  SurfaceFitWork work;
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 23}, {31, 1}, {53, 41}}) {
    for (const auto& [radius, step] : {std::pair{1, 1}, {7, 1}, {16, 1}, {1, 2}, {10, 2}}) {
      SteppedMap stepped = stepped_map(width, height);
      const DisparityMap before = stepped.map.copy();
      fit_surface(stepped.unmatched, radius, step, kSearch, execution(), work, stepped.map);
      // The same with all unmatched pixels unknown: their values have no say.
      SteppedMap unknown{before.copy(), std::move(stepped.unmatched)};
      for (const auto [x, y] : positions_of(width, height)) {
        if (unknown.unmatched.at(x, y) != 0) {
          unknown.map.at(x, y) = kUnknown;
        }
      }
      fit_surface(unknown.unmatched, radius, step, kSearch, execution(), work, unknown.map);
      for (const auto [x, y] : positions_of(width, height)) {
        if (unknown.unmatched.at(x, y) == 0) {
          ASSERT_EQ(stepped.map.at(x, y), unknown.map.at(x, y)) << x << ", " << y;
          ASSERT_LT(std::abs(stepped.map.at(x, y) - plane(x, y)), 0.75);
        } else if (std::isnan(before.at(x, y))) {
          ASSERT_TRUE(std::isnan(stepped.map.at(x, y)));
        } else {
          ASSERT_EQ(stepped.map.at(x, y), before.at(x, y));
        }
      }
    }
  }
}

TEST(FitSurface, TilesHaveTheValuesOfAWholeFit) {
  SurfaceFitWork work;
  const SteppedMap stepped = stepped_map(53, 41);
  TileMask tiles(53, 41, false, 8);
  for (const int tile : {0, 3, 5, 6}) {
    tiles.set(tile, 1);
    tiles.set(tile, 5);
  }
  for (const int step : {1, 2}) {
    DisparityMap whole = stepped.map.copy();
    fit_surface(stepped.unmatched, 10, step, kSearch, execution(), work, whole);
    DisparityMap parts = stepped.map.copy();
    fit_surface(stepped.unmatched, 10, step, kSearch, execution(), work, parts, &tiles);
    for (const auto [x, y] : positions_of(53, 41)) {
      const float expected = tiles.at(x / 8, y / 8) ? whole.at(x, y) : stepped.map.at(x, y);
      if (!std::isnan(expected)) {
        ASSERT_EQ(parts.at(x, y), expected) << x << ", " << y << ", step " << step;
      }
    }
  }
}

TEST(FitSurface, ValuesStayWithinTheSearch) {
  // Winners at the ends of the search stand for half a pixel beyond them, where the plane goes on.
  SurfaceFitWork work;
  const DisparityRange search{5, 9};
  SteppedMap stepped = stepped_map(61, 43);
  for (const auto [x, y] : positions_of(61, 43)) {
    if (stepped.map.at(x, y) < 5 || stepped.map.at(x, y) > 9) {
      stepped.unmatched.at(x, y) = 255;
    }
  }
  DisparityMap free = stepped.map.copy();
  fit_surface(stepped.unmatched, 10, 1, kSearch, execution(), work, free);
  fit_surface(stepped.unmatched, 10, 1, search, execution(), work, stepped.map);
  int outside = 0;
  for (const auto [x, y] : positions_of(61, 43)) {
    if (stepped.unmatched.at(x, y) == 0) {
      outside += free.at(x, y) < 5 || free.at(x, y) > 9 ? 1 : 0;
      // But for the last bits: samples are stored relative to the middle of the search.
      ASSERT_NEAR(stepped.map.at(x, y), std::clamp(free.at(x, y), 5.0F, 9.0F), 1e-5)
          << x << ", " << y;
    }
  }
  EXPECT_GT(outside, 20);
}

TEST(FitSurface, ExecutionsAgree) {
  SurfaceFitWork work;
  for (const int step : {1, 2}) {
    SteppedMap stepped = stepped_map(97, 151);
    DisparityMap serial = stepped.map.copy();
    Execution one({.executor = scheduler::ExecutorKind::kSerial});
    fit_surface(stepped.unmatched, 10, step, kSearch, one, work, serial);
    EXPECT_FALSE(identical(serial, stepped.map));
    Execution three({.threads = 3, .executor = scheduler::ExecutorKind::kOpenMp});
    fit_surface(stepped.unmatched, 10, step, kSearch, three, work, stepped.map);
    EXPECT_TRUE(identical(serial, stepped.map)) << step;
  }
}

TEST(FitSurface, RefinementFitsBothComponentsBeforeItFills) {
  RefinementWork work;
  SteppedMap stepped = stepped_map(40, 30);
  for (const auto [x, y] : positions_of(40, 30)) {
    stepped.map.at(x, y) = stepped.unmatched.at(x, y) != 0 ? kUnknown : stepped.map.at(x, y);
  }
  MatchedMap matched{.disparity_px = stepped.map.copy(), .disparity_y_px = stepped.map.copy()};
  const MapToRefine map{
      .side = Side::kLeft, .map = &matched, .search = kSearch, .search_y = kSearch};
  std::vector<std::string> steps;
  refine_maps({.cross_check = false, .surface_fit_px = 6}, map, nullptr, execution(), work,
              [&](std::string_view step) { steps.emplace_back(step); });
  EXPECT_THAT(steps, ::testing::ElementsAre("surface fit", "fill"));
  SurfaceFitWork alone;
  fit_surface(stepped.unmatched, 6, 1, kSearch, execution(), alone, stepped.map);
  fill_unmatched(stepped.unmatched, Side::kLeft, Fill::kConstant, execution(), stepped.map);
  EXPECT_TRUE(identical(matched.disparity_px, stepped.map));
  EXPECT_TRUE(identical(matched.disparity_y_px, stepped.map));
}

}  // namespace vantage::surface_fit_test
