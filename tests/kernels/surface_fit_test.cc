#include "kernels/surface_fit/surface_fit.h"

#include <array>
#include <cstdlib>
#include <functional>
#include <set>
#include <utility>

#include "kernels/surface_fit/surface_blocks.h"
#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::surface_fit_test {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
using Maybe = std::function<float(int x, int y)>;  // kNone: no match
constexpr SurfaceFormat kFormat = {.middle_px = 30.5F, .fraction_bits = 6};

constexpr float kSamplePx = 0.01F;  // to which samples are rounded

/// A map between margins that end where the memory does.
struct MarginMap {
  int width, height, radius_px, pitch;
  SurfaceFormat format;
  std::vector<std::int16_t> memory;

  MarginMap(int width_px, int height_px, int radius, const Maybe& disparity_px,
            const SurfaceFormat& stored = kFormat)
      : width(width_px),
        height(height_px),
        radius_px(radius),
        pitch(width_px + 2 * radius + kSurfaceRowSlack),
        format(stored),
        memory(static_cast<std::size_t>(pitch) * static_cast<std::size_t>(height_px + 2 * radius),
               kNoSurface) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const float px = disparity_px(x, y);
        const std::uint8_t unmatched = std::isnan(px) ? 255 : 0;
        surface_sample_row(&px, &unmatched, 1, format, &sample(x, y));
      }
    }
  }
  /// As it is stored.
  [[nodiscard]] float at(int x, int y) {
    return format.middle_px + static_cast<float>(sample(x, y)) / format.units_per_px();
  }
  std::int16_t& sample(int x, int y) { return memory[(y + radius_px) * pitch + x + radius_px]; }
  [[nodiscard]] bool is_matched(int x, int y) {
    return x >= 0 && y >= 0 && x < width && y < height && sample(x, y) != kNoSurface;
  }
  [[nodiscard]] SurfaceRow row(int y) {
    return {.samples = &sample(0, y),
            .pitch = pitch,
            .format = format,
            .radius_px = radius_px,
            .width = width,
            .min_px = -1e6F,
            .max_px = 1e6F};
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
void limited_row(const SurfaceRow& row, float* fitted_px) {
  SurfaceRow limited = row;
  limited.min_px = kMinPx;
  limited.max_px = kMaxPx;
  fit_surface_row(limited, fitted_px);
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

/// What is rounded besides the samples.
enum class Rounding {
  kNothing,  ///< real numbers
  kDefined,  ///< weights down to 32nds, the first plane to steps of the format
};

/// By the definition: the plane that is best for the weights of the one before, anew in each pass,
/// in map coordinates. Returns its height over the pixel.
double plane_over(MarginMap& map, int x, int y, Rounding rounding) {
  const SurfaceLattice lattice = surface_lattice(map.radius_px);
  const double own = map.at(x, y);
  const bool rounds = rounding == Rounding::kDefined;
  std::array<double, 3> plane{};
  for (int pass = 0; pass < 2; ++pass) {
    std::array<std::array<double, 3>, 3> a{};
    std::array<double, 3> b{};
    double weight = 0;
    for (int j = -lattice.steps; j <= lattice.steps; ++j) {
      for (int i = -lattice.steps; i <= lattice.steps; ++i) {
        const int column = x + lattice.column(i, j);
        const int row = y + lattice.row(i, j);
        if (!map.is_matched(column, row)) {
          continue;
        }
        const std::array<double, 3> terms = {1.0, static_cast<double>(i), static_cast<double>(j)};
        const double z = static_cast<double>(map.at(column, row)) - own;
        const double e = z - (plane[0] + plane[1] * terms[1] + plane[2] * terms[2]);
        const double share = std::max(0.0, 1 - std::abs(e) / 1.75);
        const double w = rounds ? std::floor(32 * share + 1e-6) / 32 : share;
        weight += w;
        for (std::size_t k = 0; k < 3; ++k) {
          for (std::size_t l = 0; l < 3; ++l) {
            a[k][l] += w * terms[k] * terms[l];
          }
          b[k] += w * terms[k] * z;
        }
      }
    }
    if (weight == 0) {
      return plane[0];
    }
    const double ridge = weight / 16384 * lattice.steps * lattice.steps;
    for (std::size_t k = 1; k < 3; ++k) {  // slopes are drawn to those before
      a[k][k] += ridge;
      b[k] += ridge * plane[k];
    }
    plane = solve(a, b);
    for (double& value : plane) {
      if (rounds && pass == 0) {
        value = std::clamp(std::nearbyint(value * 64) / 64, -4.0, 4.0);
      }
    }
  }
  return plane[0];
}

VANTAGE_ON_EVERY_TARGET(SurfaceFit);

TEST(SurfaceFit, EqualsPlainTranscription) {
  std::mt19937 random(51);
  double sum_of_rounding = 0;
  int pixels = 0;
  for (const auto& [width, height] :
       {std::pair{1, 1}, {1, 9}, {13, 1}, {2, 3}, {7, 5}, {8, 4}, {17, 11}, {31, 7}, {67, 9}}) {
    for (const int radius : {1, 2, 3, 5, 10, 16}) {
      // Slanted, in whole pixels and beside them, with a jump and stray values.
      MarginMap map(width, height, radius, [&, w = width](int x, int y) {
        const int kind = random_int(random, 0, 9);
        const float slope = 0.21F * static_cast<float>(x) - 0.13F * static_cast<float>(y);
        const float noise = 0.01F * static_cast<float>(random_int(random, -30, 30));
        const float jump = x > w / 2 ? 3.0F : 0.0F;
        return kind == 0 ? kNone : std::round(slope) + noise + jump + (kind == 1 ? 1.2F : 0.0F);
      });
      for (int y = 0; y < height; ++y) {
        const std::vector<float> simd = fitted(map, y, fit_surface_row);
        const std::vector<float> limited = fitted(map, y, limited_row);
        for_each_target([&] {
          ASSERT_EQ(fitted(map, y, fit_surface_row), simd) << "radius " << radius;
          ASSERT_EQ(fitted(map, y, limited_row), limited);
        });
        ASSERT_TRUE(is_limited(map, y, simd, limited));
        for (int x = 0; x < width; ++x) {
          const float value = simd[x];
          if (!map.is_matched(x, y)) {
            ASSERT_EQ(value, kBefore);
            continue;
          }
          const double move = plane_over(map, x, y, Rounding::kDefined);
          if (std::abs(std::abs(move) - kMaxSurfaceMovePx) < 1e-3) {
            continue;  // on the brink
          }
          const bool is_moved = std::abs(move) < kMaxSurfaceMovePx;
          ASSERT_NEAR(value, map.at(x, y) + (is_moved ? move : 0), 1e-3)
              << x << ", " << y << " of " << width << 'x' << height << ", radius " << radius;
          if (is_moved && radius >= 2) {  // of 9 samples, few have a say
            sum_of_rounding += std::abs(move - plane_over(map, x, y, Rounding::kNothing));
            ++pixels;
          }
        }
      }
    }
  }
  EXPECT_LT(sum_of_rounding / pixels, 0.005);
}

TEST_P(SurfaceFit, PlanesStayUpToTheBorder) {
  std::mt19937 random(52);
  const auto plane = [](int x, int y) {
    return 20 + 0.15F * static_cast<float>(x) - 0.08F * static_cast<float>(y);
  };
  for (const int radius : {1, 4, 10, 16}) {
    MarginMap map(45, 37, radius, [&](int x, int y) {
      return random_int(random, 0, 4) == 0 ? kNone : plane(x, y);
    });
    for (int y = 0; y < map.height; ++y) {
      const std::vector<float> row = fitted(map, y, fit_surface_row);
      for (int x = 0; x < map.width; ++x) {
        if (map.is_matched(x, y)) {
          ASSERT_NEAR(row[x], plane(x, y), kSamplePx) << x << ", " << y;
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
        ASSERT_NEAR(row[x], planes(x, y), kSamplePx) << x << ", " << y;
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
      squares_after += std::pow(row[x] - plane(x, y), 2);
    }
  }
  EXPECT_LT(squares_after, squares_before / 16);
}

TEST_P(SurfaceFit, EndsOfTheRangeAreLikeItsMiddle) {
  // Planes that leave the range, beside pixels without a match.
  std::mt19937 random(53);
  const SurfaceFormat format = surface_format(0, 971);
  EXPECT_EQ(format.fraction_bits, 6);
  for (const float offset_px : {-486.0F, 482.0F}) {
    const auto make = [&](float from_px) {
      std::mt19937 same(random);
      return MarginMap(
          40, 20, 10,
          [&, from_px](int x, int y) {
            const int slope = x - 2 * y + random_int(same, -3, 3);
            return random_int(same, 0, 2) == 0
                       ? kNone
                       : from_px + std::clamp(static_cast<float>(slope) / 4, -3.0F, 7.0F);
          },
          format);
    };
    MarginMap middle = make(format.middle_px);
    MarginMap end = make(format.middle_px + offset_px);
    for (int y = 0; y < middle.height; ++y) {
      const std::vector<float> expected = fitted(middle, y, fit_surface_row);
      const std::vector<float> moved = fitted(end, y, fit_surface_row);
      for (int x = 0; x < middle.width; ++x) {
        const auto i = static_cast<std::size_t>(x);
        ASSERT_NEAR(moved[i], expected[i] == kBefore ? kBefore : expected[i] + offset_px, 1e-4);
      }
    }
  }
}

TEST(SurfaceFit, SamplesAreNearestSteps) {
  std::vector<float> px;
  std::vector<std::uint8_t> unmatched;
  for (int i = 0; i < 77; ++i) {
    px.push_back(i % 7 == 0 ? NAN : 30.5F + static_cast<float>(i - 38) * 31.7F / 64);
    unmatched.push_back(i % 7 == 0 ? 255 : 0);
  }
  px[1] = 30.5F + 0.5F / 64;  // halves
  px[2] = 30.5F + 1.5F / 64;
  px[3] = 1e6F;
  px[4] = -1e6F;
  const auto reference = row_on_every_target<std::int16_t>(px.size(), surface_sample_row, px.data(),
                                                           unmatched.data(), 77, kFormat);
  EXPECT_EQ(std::vector<int>(reference.begin(), reference.begin() + 5),
            (std::vector<int>{kNoSurface, 0, 2, 31359, -31359}));
  EXPECT_EQ(reference[39], std::lround(31.7));
}

TEST(SurfaceFormats, HoldTheirRanges) {
  for (const auto& [width, bits] : {std::pair{0, 6},
                                    {971, 6},
                                    {972, 5},
                                    {1995, 5},
                                    {1996, 4},
                                    {4043, 4},
                                    {4044, 3},
                                    {8139, 3}}) {
    const SurfaceFormat format = surface_format(-7, width - 7);
    EXPECT_EQ(format.fraction_bits, bits) << width;
    EXPECT_GE(static_cast<float>(max_surface_sample(format)) / format.units_per_px(),
              static_cast<float>(width) / 2 + kSurfaceRangeMarginPx);
  }
}

TEST(SurfaceFormats, SumsFit16Bits) {
  for (const SurfaceLattice& lattice :
       {surface_lattice(1), surface_lattice(10), surface_block_lattice(10)}) {
    for (const int bits : {3, 4, 5, 6}) {
      const SurfaceWeights weights = surface_weights(lattice, {.fraction_bits = bits});
      int we = 0;  // the largest sums there can be
      int weu = 0;
      int wuu = 0;
      for (int j = -lattice.steps; j <= lattice.steps; ++j) {
        for (int i = -lattice.steps; i <= lattice.steps; ++i) {
          const int share = weights.share[i * i + j * j];
          int largest = 0;
          for (int e = 0; e < weights.reach; ++e) {
            largest = std::max(largest, (((weights.reach - e) * share) >> 16) * e);
          }
          we += largest;
          weu += largest * std::abs(i);
          wuu += ((weights.reach * share) >> 16) * i * i;
        }
      }
      EXPECT_LE(std::max({we, weu, wuu}), 32767) << bits;
      EXPECT_GE(wuu, 6 * 8 * lattice.steps * lattice.steps) << "weights of few steps";
    }
  }
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

}  // namespace vantage::kernels::surface_fit_test
