#include "kernels/surface_fit/surface_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels {
namespace surface_fit_test {

using Maybe = std::function<float(int x, int y)>;  // kNoSurfacePx: no match

/// A map between margins that end where the memory does.
struct MarginMap {
  int width, height, radius_px, pitch;
  std::vector<float> memory;

  MarginMap(int width_px, int height_px, int radius, const Maybe& disparity_px)
      : width(width_px),
        height(height_px),
        radius_px(radius),
        pitch(width_px + 2 * radius + kSurfaceRowSlack),
        memory(static_cast<std::size_t>(pitch) * static_cast<std::size_t>(height_px + 2 * radius),
               kNoSurfacePx) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        at(x, y) = disparity_px(x, y);
      }
    }
  }
  float& at(int x, int y) {
    return memory[static_cast<std::size_t>((y + radius_px) * pitch + x + radius_px)];
  }
  [[nodiscard]] bool is_matched(int x, int y) {
    return x >= 0 && y >= 0 && x < width && y < height && at(x, y) != kNoSurfacePx;
  }
  [[nodiscard]] SurfaceRow row(int y) {
    return {.disparity_px = &at(0, y), .pitch = pitch, .radius_px = radius_px, .width = width};
  }
};

constexpr float kBefore = -7;  // what unmatched pixels are before and after

/// Row y after fitting.
std::vector<float> fitted(MarginMap& map, int y, decltype(fit_surface_row)* fit) {
  const auto width = static_cast<std::size_t>(map.width);
  GuardedRow<float> row(width, 3, -99.0F);
  for (int x = 0; x < map.width; ++x) {
    row.data()[x] = map.is_matched(x, y) ? map.at(x, y) : kBefore;
  }
  fit(map.row(y), row.data());
  EXPECT_TRUE(row.intact());
  return row.values();
}

constexpr float kMinPx = -0.75F;
constexpr float kMaxPx = 2.0F;

/// Fits a row within limits.
template <decltype(fit_surface_row)* kFit>
void limited_row(const SurfaceRow& row, float* fitted_px) {
  SurfaceRow limited = row;
  limited.min_px = kMinPx;
  limited.max_px = kMaxPx;
  kFit(limited, fitted_px);
}

/// Whether `limited` is `row` but for the limits. Pixels that keep what they are need none, as
/// their values come from the search.
bool is_limited(MarginMap& map, int y, const std::vector<float>& row,
                const std::vector<float>& limited) {
  for (int x = 0; x < map.width; ++x) {
    const auto i = static_cast<std::size_t>(x);
    const bool may_be_kept = !map.is_matched(x, y) || row[i] == map.at(x, y);
    if (limited[i] != std::clamp(row[i], kMinPx, kMaxPx) &&
        !(may_be_kept && limited[i] == row[i])) {
      return false;
    }
  }
  return true;
}

/// Solves a · x = b by elimination.
std::array<double, 3> solve(std::array<std::array<double, 3>, 3> a, std::array<double, 3> b) {
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = k + 1; i < 3; ++i) {
      const double factor = a[i][k] / a[k][k];
      for (std::size_t j = k; j < 3; ++j) {
        a[i][j] -= factor * a[k][j];
      }
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = 3; k-- > 0;) {
    for (std::size_t j = k + 1; j < 3; ++j) {
      b[k] -= a[k][j] * b[j];
    }
    b[k] /= a[k][k];
  }
  return b;
}

/// By the definition: the plane that is best for the weights of the one before, anew in each pass,
/// in map coordinates. Returns its height over the pixel.
double plane_over(MarginMap& map, int x, int y) {
  const SurfaceLattice lattice = surface_lattice(map.radius_px);
  const double own = map.at(x, y);
  std::array<double, 3> plane{};
  for (int pass = 0; pass < 2; ++pass) {
    std::array<std::array<double, 3>, 3> a{};
    std::array<double, 3> b{};
    double weight = 1e-6;
    for (int j = -lattice.steps; j <= lattice.steps; ++j) {
      for (int i = -lattice.steps; i <= lattice.steps; ++i) {
        const int column = x + lattice.column(i, j);
        const int row = y + lattice.row(i, j);
        if (!map.is_matched(column, row)) {
          continue;
        }
        const std::array<double, 3> terms = {1, static_cast<double>(i) / lattice.steps,
                                             static_cast<double>(j) / lattice.steps};
        const double z = static_cast<double>(map.at(column, row)) - own;
        const double e = z - (plane[0] + plane[1] * terms[1] + plane[2] * terms[2]);
        const double w = std::max(0.0, 1 - e * e / (1.5 * 1.5));
        weight += w;
        for (std::size_t k = 0; k < 3; ++k) {
          for (std::size_t l = 0; l < 3; ++l) {
            a[k][l] += w * terms[k] * terms[l];
          }
          b[k] += w * terms[k] * z;
        }
      }
    }
    a[0][0] += 1e-6;
    b[0] += 1e-6 * plane[0];
    for (std::size_t k = 1; k < 3; ++k) {  // slopes are drawn to those before
      a[k][k] += weight * kSlopeRidge;
      b[k] += weight * kSlopeRidge * plane[k];
    }
    plane = solve(a, b);
  }
  return plane[0];
}

class SurfaceFit : public EveryTarget {};
VANTAGE_ON_EVERY_TARGET(SurfaceFit);

TEST_P(SurfaceFit, EqualsPlainTranscription) {
  std::mt19937 random(51);
  for (const auto& [width, height] :
       {std::pair{1, 1}, {1, 9}, {13, 1}, {2, 3}, {7, 5}, {8, 4}, {17, 11}, {31, 7}, {67, 9}}) {
    for (const int radius : {1, 2, 3, 5, 10, 16}) {
      // Slanted, in whole pixels and beside them, with a jump and stray values.
      MarginMap map(width, height, radius, [&](int x, int y) {
        const int kind = random_int(random, 0, 9);
        const float slope = 0.21F * static_cast<float>(x) - 0.13F * static_cast<float>(y);
        const float noise = 0.01F * static_cast<float>(random_int(random, -30, 30));
        const float jump = x > width / 2 ? 3.0F : 0.0F;
        return kind == 0 ? kNoSurfacePx
                         : std::round(slope) + noise + jump + (kind == 1 ? 1.2F : 0.0F);
      });
      for (int y = 0; y < height; ++y) {
        const std::vector<float> simd = fitted(map, y, fit_surface_row);
        ASSERT_EQ(simd, fitted(map, y, fit_surface_row_ref)) << "radius " << radius;
        const std::vector<float> limited = fitted(map, y, limited_row<fit_surface_row>);
        ASSERT_EQ(limited, fitted(map, y, limited_row<fit_surface_row_ref>));
        ASSERT_TRUE(is_limited(map, y, simd, limited));
        for (int x = 0; x < width; ++x) {
          const float value = simd[static_cast<std::size_t>(x)];
          if (!map.is_matched(x, y)) {
            ASSERT_EQ(value, kBefore);
            continue;
          }
          const double move = plane_over(map, x, y);
          if (std::abs(std::abs(move) - kSurfaceReachPx) < 1e-3) {
            continue;  // on the brink
          }
          const double expected = map.at(x, y) + (std::abs(move) < kSurfaceReachPx ? move : 0);
          ASSERT_NEAR(value, expected, 1e-3)
              << x << ", " << y << " of " << width << 'x' << height << ", radius " << radius;
        }
      }
    }
  }
}

TEST_P(SurfaceFit, PlanesStayUpToTheBorder) {
  std::mt19937 random(52);
  const auto plane = [](int x, int y) {
    return 20 + 0.15F * static_cast<float>(x) - 0.08F * static_cast<float>(y);
  };
  for (const int radius : {1, 4, 10, 16}) {
    MarginMap map(45, 37, radius, [&](int x, int y) {
      return random_int(random, 0, 4) == 0 ? kNoSurfacePx : plane(x, y);
    });
    for (int y = 0; y < map.height; ++y) {
      const std::vector<float> row = fitted(map, y, fit_surface_row);
      for (int x = 0; x < map.width; ++x) {
        if (map.is_matched(x, y)) {
          ASSERT_NEAR(row[static_cast<std::size_t>(x)], plane(x, y), 1e-4) << x << ", " << y;
        }
      }
    }
  }
}

TEST_P(SurfaceFit, SurfacesAcrossADepthEdgeHaveNoSay) {
  const auto planes = [](int x, int y) {
    const float slope = 0.04F * static_cast<float>(x) + 0.06F * static_cast<float>(y);
    return x + y / 2 < 25 ? 10 + slope : 15 - slope / 4;
  };
  for (const int radius : {3, 10}) {
    MarginMap map(43, 31, radius, planes);
    for (int y = 0; y < map.height; ++y) {
      const std::vector<float> row = fitted(map, y, fit_surface_row);
      for (int x = 0; x < map.width; ++x) {
        ASSERT_NEAR(row[static_cast<std::size_t>(x)], planes(x, y), 1e-4) << x << ", " << y;
      }
    }
  }
}

TEST_P(SurfaceFit, StepsBecomeThePlaneTheyStandFor) {
  const auto plane = [](int x, int y) {
    return 20 + 0.23F * static_cast<float>(x) - 0.11F * static_cast<float>(y);
  };
  MarginMap map(60, 40, 10, [&](int x, int y) { return std::round(plane(x, y)); });
  double squares_before = 0;
  double squares_after = 0;
  for (int y = 0; y < map.height; ++y) {
    const std::vector<float> row = fitted(map, y, fit_surface_row);
    for (int x = 0; x < map.width; ++x) {
      squares_before += std::pow(map.at(x, y) - plane(x, y), 2);
      squares_after += std::pow(row[static_cast<std::size_t>(x)] - plane(x, y), 2);
    }
  }
  EXPECT_LT(squares_after, squares_before / 16);
}

TEST(SurfaceLattice, SamplesAreApartAndInsideTheWindow) {
  for (int radius = 1; radius <= kMaxSurfaceRadiusPx; ++radius) {
    const SurfaceLattice lattice = surface_lattice(radius);
    std::set<std::pair<int, int>> places;
    int reach = 0;
    for (int j = -lattice.steps; j <= lattice.steps; ++j) {
      for (int i = -lattice.steps; i <= lattice.steps; ++i) {
        places.emplace(lattice.column(i, j), lattice.row(i, j));
        reach = std::max({reach, std::abs(lattice.column(i, j)), std::abs(lattice.row(i, j))});
      }
    }
    const int side = 2 * lattice.steps + 1;
    EXPECT_EQ(places.size(), static_cast<std::size_t>(side * side)) << radius;
    EXPECT_LE(reach, radius);
    EXPECT_GE(reach, radius - 1);
  }
}

}  // namespace surface_fit_test
}  // namespace vantage::kernels
