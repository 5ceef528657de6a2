#include "engine/refinement/canonical_fill.h"

#include "engine/refinement/refine_maps.h"
#include "engine/refinement/uniform_pixels.h"
#include "tests/engine/engine_test.h"

namespace vantage::canonical_fill_test {

/// A map whose values are known everywhere but in a region.
struct Hole {
  DisparityMap map;
  Mask region;
  Image<float> grey;

  Hole(int width, int height, const std::function<float(int, int)>& value,
       const std::function<bool(int, int)>& is_inside)
      : map(width, height), region(width, height), grey(width, height) {
    grey.fill(0);
    for (const auto [x, y] : positions_of(width, height)) {
      region.at(x, y) = is_inside(x, y) ? 255 : 0;
      map.at(x, y) = is_inside(x, y) ? std::nanf("") : value(x, y);
    }
  }

  void fill(SurfaceEnergy energy, int threads = 1) {
    Execution execution({.threads = threads});
    Mask unmatched = region.copy();
    fill_canonically(region, grey, energy, kAnyDisparity, execution, unmatched, map);
  }
};

TEST(CanonicalFill, OfARowIsAStraightLine) {
  Hole row(
      9, 1, [](int x, int) { return x == 0 ? 3.0F : 3.8F; },
      [](int x, int) { return x > 0 && x < 8; });
  row.fill(SurfaceEnergy::kMembrane);
  for (int x = 0; x < 9; ++x) {
    EXPECT_NEAR(row.map.at(x, 0), 3 + 0.1 * x, 1e-5);
  }
}

/// Outlines with notches, touching the image's border on one side.
bool is_in_region(int x, int y) {
  return (x - 20) * (x - 20) + (y - 3) * (y - 3) < 17 * 17 && (x % 5 != 2 || y % 4 != 1);
}

TEST(CanonicalFill, OfAPlaneIsThePlaneInBothDirections) {
  const auto plane = [](int x, int y) {
    return 5 + 0.03F * static_cast<float>(x) - 0.05F * static_cast<float>(y);
  };
  for (const SurfaceEnergy energy : {SurfaceEnergy::kMembrane, SurfaceEnergy::kThinPlate}) {
    // The membrane is level at the image's border; a plate continues the slope.
    const int top = energy == SurfaceEnergy::kMembrane ? 30 : 3;
    Hole hole(43, 60, plane, [top](int x, int y) { return is_in_region(x, y - top + 3); });
    hole.fill(energy);
    for (const auto [x, y] : positions_of(43, 60)) {
      ASSERT_NEAR(hole.map.at(x, y), plane(x, y), 5e-3) << x << ", " << y;
    }
  }
}

/// Sum over neighbours of squared differences, or of squared second differences, that reach into
/// the region; the map is one surface, so that all of its pixels take part.
double plain_energy(SurfaceEnergy energy, const DisparityMap& map, const Mask& region) {
  const bool is_plate = energy == SurfaceEnergy::kThinPlate;
  double sum = 0;
  struct Part {
    int x, y;
    double factor;
  };
  const auto add = [&](double weight, int x, int y, const std::vector<Part>& parts) {
    double value = 0;
    bool is_inside = false;
    for (const Part& part : parts) {
      const int column = x + part.x;
      const int row = y + part.y;
      if (column >= map.width() || row >= map.height()) {
        return;
      }
      is_inside = is_inside || region.at(column, row) != 0;
      value += part.factor * static_cast<double>(map.at(column, row));
    }
    sum += is_inside ? weight * value * value : 0;
  };
  for (const auto [x, y] : positions_of(map)) {
    add(is_plate ? 1e-3 : 1, x, y, {{0, 0, 1}, {1, 0, -1}});
    add(is_plate ? 1e-3 : 1, x, y, {{0, 0, 1}, {0, 1, -1}});
    if (is_plate) {
      add(1, x, y, {{0, 0, 1}, {1, 0, -2}, {2, 0, 1}});
      add(1, x, y, {{0, 0, 1}, {0, 1, -2}, {0, 2, 1}});
      add(2, x, y, {{0, 0, 1}, {1, 0, -1}, {0, 1, -1}, {1, 1, 1}});
    }
  }
  return sum;
}

TEST(CanonicalFill, HasTheLeastEnergy) {
  for (const SurfaceEnergy energy : {SurfaceEnergy::kMembrane, SurfaceEnergy::kThinPlate}) {
    const auto wavy = [](int x, int y) {
      return 5 + 0.2F * std::sin(0.7F * static_cast<float>(x)) +
             0.2F * std::cos(0.5F * static_cast<float>(y));
    };
    Hole hole(41, 23, wavy, is_in_region);
    hole.fill(energy);
    for (const auto [x, y] : positions_of(41, 23)) {
      if (hole.region.at(x, y) == 0) {
        EXPECT_EQ(hole.map.at(x, y), wavy(x, y));
        continue;
      }
      // The derivative of a quadratic function by symmetric differences is exact.
      float& value = hole.map.at(x, y);
      const float minimum = value;
      value = minimum + 0.5F;
      const double above = plain_energy(energy, hole.map, hole.region);
      value = minimum - 0.5F;
      const double below = plain_energy(energy, hole.map, hole.region);
      value = minimum;
      ASSERT_NEAR(above - below, 0, 2e-5) << x << ", " << y;
    }
  }
}

TEST(CanonicalFill, OfALargeRegionIsAsExact) {
  // x² − y² is harmonic on the grid too.
  const auto saddle = [](int x, int y) {
    return 20 + 2e-4F * static_cast<float>((x - 70) * (x - 70) - (y - 55) * (y - 55));
  };
  for (const SurfaceEnergy energy : {SurfaceEnergy::kMembrane, SurfaceEnergy::kThinPlate}) {
    Hole hole(141, 113, saddle, [](int x, int y) {
      return x > 2 && x < 137 && y > 3 && y < 109 && (x % 47 != 20 || y % 31 != 11);
    });
    hole.fill(energy);
    for (const auto [x, y] : positions_of(141, 113)) {
      ASSERT_NEAR(hole.map.at(x, y), saddle(x, y), energy == SurfaceEnergy::kMembrane ? 0.02 : 0.1)
          << x << ", " << y;
    }
  }
}

TEST(CanonicalFill, LeavesOutEndsOfASurfaceInFront) {
  const auto filled = [](float grey_of_left, float grey_of_right) {
    Hole row(
        12, 3, [](int x, int) { return x < 2 ? 30.0F : 10.0F; },
        [](int x, int) { return x >= 2 && x < 10; });
    for (int y = 0; y < 3; ++y) {
      row.grey.at(1, y) = grey_of_left;
      row.grey.at(10, y) = grey_of_right;
    }
    row.fill(SurfaceEnergy::kMembrane);
    return row.map.at(5, 1);
  };
  EXPECT_NEAR(filled(0, 0), 10, 1e-4);   // the nearer end is
  EXPECT_NEAR(filled(0, 40), 30, 1e-4);  // unless the other alone looks different
  EXPECT_NEAR(filled(40, 0), 10, 1e-4);
  EXPECT_NEAR(filled(30, 40), 10, 1e-4);
}

TEST(UniformPixels, TextureIsTheMeanDifferenceOfSomeWindow) {
  std::mt19937 random(3);
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 2}, {17, 9}, {40, 31}}) {
    Image<std::uint8_t> image(width, height);
    for (const auto [x, y] : positions_of(width, height)) {
      image.at(x, y) = static_cast<std::uint8_t>(90 + random() % (x < 2 * width / 3 ? 3 : 40));
    }
    const auto is_flat = [&](int x, int y) {
      int sum = 0;
      for (int row = std::max(y - 3, 0); row <= std::min(y + 3, height - 1); ++row) {
        for (int column = std::max(x - 3, 0); column <= std::min(x + 2, width - 2); ++column) {
          sum += std::abs(image.at(column + 1, row) - image.at(column, row));
        }
      }
      return sum <= 42;  // a mean of 1
    };
    UniformPixelsWork work;
    Mask textureless;
    find_textureless_pixels(Photograph{image.copy()}, 1.0, execution(), work, textureless);
    for (const auto [x, y] : positions_of(width, height)) {
      bool expected = false;
      for (int row = std::max(y - 3, 0); row <= std::min(y + 3, height - 1); ++row) {
        for (int column = std::max(x - 3, 0); column <= std::min(x + 3, width - 1); ++column) {
          expected = expected || is_flat(column, row);
        }
      }
      ASSERT_EQ(textureless.at(x, y) != 0, expected) << x << ", " << y;
    }
  }
}

/// Unmatched columns 5 to 19 between a background of 4 and a surface of 12, which hides 8 columns.
TEST(UniformPixels, HiddenOnesAreNotUniform) {
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const auto column = [side](int x) { return side == Side::kLeft ? x : 29 - x; };
    DisparityMap map(30, 1);
    Mask unmatched(30, 1);
    for (int x = 0; x < 30; ++x) {
      map.at(column(x), 0) = x < 5 ? 4 : 12;
      unmatched.at(column(x), 0) = x >= 5 && x < 20 ? 255 : 0;
    }
    Mask uniform(30, 1);
    uniform.fill(255);
    keep_visible_unmatched(map.view(), unmatched, side, 1, execution(), uniform);
    for (int x = 0; x < 30; ++x) {
      EXPECT_EQ(uniform.at(column(x), 0) != 0, x >= 5 && x < 12) << x;
    }
    // All of them would lie outside the other image.
    for (int x = 0; x < 30; ++x) {
      map.at(column(x), 0) = 25;
    }
    uniform.fill(255);
    keep_visible_unmatched(map.view(), unmatched, side, 1, execution(), uniform);
    for (int x = 0; x < 30; ++x) {
      EXPECT_EQ(uniform.at(column(x), 0), 0) << x;
    }
  }
}

/// A grey wall, slanted by a pixel per 20 columns and 40 rows, with a textured frame and, in the
/// middle, a textured card in front of it that hides a strip at its left.
TEST(CanonicalFill, OfAUniformWallAroundACard) {
  constexpr int kWidth = 120;
  constexpr int kHeight = 90;
  const auto wall = [](int x, int y) {
    return 4 + static_cast<float>(x) / 20 + static_cast<float>(y) / 40;
  };
  Image<std::uint8_t> image(kWidth, kHeight);
  MatchedMap map{.disparity_px = DisparityMap(kWidth, kHeight),
                 .disparity_y_px = DisparityMap(kWidth, kHeight)};
  std::mt19937 random(5);
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    const bool is_card = x >= 60 && x < 90 && y >= 30 && y < 70;
    const bool is_frame = x < 20 || x >= 110 || y < 6 || y >= 84;
    image.at(x, y) =
        static_cast<std::uint8_t>(is_card || is_frame ? 40 + random() % 30 : 128 + random() % 2);
    map.disparity_px.at(x, y) = is_card ? 25 : is_frame ? wall(x, y) : std::nanf("");
  }
  const Photograph photograph{std::move(image)};
  const auto worst_px = [&](Fill fill, int threads, MatchedMap& refined) {
    refined = {.disparity_px = map.disparity_px.copy(), .disparity_y_px = map.disparity_px.copy()};
    RefinementOptions options;
    options.cross_check = false;
    options.fill = fill;
    Execution execution({.threads = threads});
    RefinementWork work;
    refine_maps(options, {.side = Side::kLeft, .image = &photograph, .map = &refined}, nullptr,
                execution, work, [](std::string_view) {});
    EXPECT_TRUE(identical(refined.disparity_px, refined.disparity_y_px));
    EXPECT_EQ(refined.unmatched.at(50, 50), 255);
    float worst = 0;
    for (const auto [x, y] : positions_of({20, 110}, {0, kHeight})) {
      if (x < 60 || x >= 90 || y < 30 || y >= 70) {
        worst = std::max(worst, std::abs(refined.disparity_px.at(x, y) - wall(x, y)));
      }
    }
    return worst;
  };
  MatchedMap refined;
  MatchedMap on_one_thread;
  EXPECT_LT(worst_px(Fill::kCanonical, 2, refined), 2);
  worst_px(Fill::kCanonical, 1, on_one_thread);
  EXPECT_TRUE(identical(refined.disparity_px, on_one_thread.disparity_px));
  EXPECT_LT(worst_px(Fill::kThinPlate, 2, refined), 2);
  EXPECT_GT(worst_px(Fill::kMedian, 1, refined), 3);
}

}  // namespace vantage::canonical_fill_test
