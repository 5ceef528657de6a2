#include "kernels/surface_fit/surface_blocks.h"

#include <functional>
#include <utility>

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::surface_blocks_test {

/// Implementation under test.
struct Kernels {
  decltype(surface_block_row)* block_row = surface_block_row;
  decltype(fit_surface_block_row)* fit = fit_surface_block_row;
};
constexpr Kernels kReference{surface_block_row_ref, fit_surface_block_row_ref};

/// A map in rows that end where the memory does.
struct PixelMap {
  int width, height;
  std::vector<GuardedRow<float>> px;
  std::vector<UnalignedRow<std::uint8_t>> unmatched;

  PixelMap(int columns, int rows, const std::function<float(int x, int y)>& disparity_px)
      : width(columns), height(rows) {
    const auto size = static_cast<std::size_t>(width);
    for (int y = 0; y < height; ++y) {
      px.emplace_back(size, 3, -99.0F);
      unmatched.emplace_back(size, 1);
      for (int x = 0; x < width; ++x) {
        px.back().data()[x] = disparity_px(x, y);
      }
    }
  }
  float& at(int x, int y) { return px[y].data()[x]; }
  std::uint8_t& mask(int x, int y) { return unmatched[y].data()[x]; }
  SurfaceBlockRow row(int y) {
    const bool has_lower = y + 1 < height;
    return {.upper_px = &at(0, y),
            .lower_px = has_lower ? &at(0, y + 1) : nullptr,
            .upper_unmatched = &mask(0, y),
            .lower_unmatched = has_lower ? &mask(0, y + 1) : nullptr,
            .width = width};
  }
};

constexpr SurfaceFormat kFormat = {.middle_px = 10.5F, .fraction_bits = 6};
constexpr float kMinPx = -100;
constexpr float kMaxPx = 25;

/// The blocks of the map; fits the map.
std::vector<std::vector<std::int16_t>> fit(PixelMap& map, int radius_px,
                                           const Kernels& kernels = {}) {
  const int margin = surface_block_margin(radius_px);
  const int columns = surface_blocks(map.width);
  const int rows = surface_blocks(map.height);
  const auto pitch = static_cast<std::size_t>(columns + 2 * margin + kSurfaceRowSlack);
  std::vector<std::int16_t> memory(pitch * static_cast<std::size_t>(rows + 2 * margin), kNoSurface);
  const auto place = [&](int row) {
    return memory.data() + static_cast<std::size_t>(row + margin) * pitch + margin;
  };
  std::vector<std::vector<std::int16_t>> blocks;
  for (int row = 0; row < rows; ++row) {
    GuardedRow<std::int16_t> values(columns, 1, -99);
    kernels.block_row(map.row(2 * row), kFormat, values.data());
    EXPECT_TRUE(values.intact());
    blocks.push_back(values.values());
    std::copy(blocks.back().begin(), blocks.back().end(), place(row));
  }
  for (int row = 0; row < rows; ++row) {
    kernels.fit({.samples = place(row),
                 .pitch = static_cast<std::ptrdiff_t>(pitch),
                 .format = kFormat,
                 .radius_px = radius_px,
                 .width = columns,
                 .min_px = kMinPx,
                 .max_px = kMaxPx},
                map.row(2 * row));
  }
  for (const GuardedRow<float>& row : map.px) {
    EXPECT_TRUE(row.intact());
  }
  return blocks;
}

VANTAGE_ON_EVERY_TARGET(SurfaceBlocks);

TEST_P(SurfaceBlocks, EqualReference) {
  for (const auto& [width, height] :
       {std::pair{1, 1}, {1, 9}, {13, 1}, {2, 3}, {7, 6}, {17, 11}, {31, 7}, {67, 9}, {130, 4}}) {
    for (const int radius : {1, 2, 5, 10, 16}) {
      const auto map = [&, w = width, h = height] {
        std::mt19937 random(51);
        // Slanted, in whole pixels and beside them, with a jump, stray values and gaps.
        PixelMap result(w, h, [&](int x, int y) {
          const float slope = 0.21F * static_cast<float>(x) - 0.13F * static_cast<float>(y);
          const float noise = 0.01F * static_cast<float>(random_int(random, -30, 30));
          const float stray = random_int(random, 0, 9) == 0 ? 1.2F : 0.0F;
          return std::round(slope) + noise + (x > w / 2 ? 3.0F : 0.0F) + stray;
        });
        for (int y = 0; y < h; ++y) {
          for (int x = 0; x < w; ++x) {
            result.mask(x, y) = random_int(random, 0, 3) == 0 ? 255 : 0;
            result.at(x, y) = result.mask(x, y) != 0 && x % 2 == 0 ? NAN : result.at(x, y);
          }
        }
        return result;
      };
      PixelMap simd = map();
      PixelMap reference = map();
      PixelMap before = map();
      ASSERT_EQ(fit(simd, radius), fit(reference, radius, kReference));
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          if (before.mask(x, y) != 0) {
            reference.at(x, y) = before.at(x, y);  // stays, also where it is NaN
          }
          ASSERT_TRUE(simd.at(x, y) == reference.at(x, y) ||
                      (std::isnan(simd.at(x, y)) && std::isnan(reference.at(x, y))))
              << x << ", " << y << " of " << width << 'x' << height << ", radius " << radius;
        }
      }
    }
  }
}

TEST_P(SurfaceBlocks, PlanesStayUpToTheBorder) {
  const auto plane = [](int x, int y) {
    return 20 + 0.15F * static_cast<float>(x) - 0.08F * static_cast<float>(y);
  };
  for (const int radius : {1, 4, 10, 16}) {
    PixelMap map(44, 36, plane);
    // Whole columns of blocks: where single pixels are missing, a block's mean is off its centre.
    for (int y = 0; y < map.height; ++y) {
      for (int x = 0; x < map.width; ++x) {
        map.mask(x, y) = x / 2 % 5 == 3 ? 255 : 0;
      }
    }
    fit(map, radius);
    for (int y = 0; y < map.height; ++y) {
      for (int x = 0; x < map.width; ++x) {
        ASSERT_NEAR(map.at(x, y), map.mask(x, y) != 0 ? plane(x, y) : std::min(plane(x, y), kMaxPx),
                    1e-2)  // samples are rounded to 1/64 px
            << x << ", " << y << ", radius " << radius;
      }
    }
  }
}

TEST_P(SurfaceBlocks, WinnersOfBlocksBecomeThePlaneTheyStandFor) {
  const auto plane = [](int x, int y) {
    return 10 + 0.23F * static_cast<float>(x) - 0.11F * static_cast<float>(y);
  };
  // One winner for each block, at its centre.
  PixelMap map(60, 40, [&](int x, int y) {
    return std::round(plane(x / 2 * 2, y / 2 * 2) + (0.23F - 0.11F) / 2);
  });
  double squares_before = 0;
  double squares_after = 0;
  for (const bool is_after : {false, true}) {
    if (is_after) {
      fit(map, 10);
    }
    for (int y = 0; y < map.height; ++y) {
      for (int x = 0; x < map.width; ++x) {
        (is_after ? squares_after : squares_before) += std::pow(map.at(x, y) - plane(x, y), 2);
      }
    }
  }
  EXPECT_LT(squares_after, squares_before / 12);
}

TEST_P(SurfaceBlocks, BlocksAreOfOneSurface) {
  PixelMap map(6, 2, [&](int x, int y) {
    constexpr float kRows[2][6] = {{3, 4, 3, 8, 9, 9}, {3, 4, 4, 9, 9, 9}};
    return kRows[y][x];
  });
  map.mask(1, 1) = 255;
  for (const int x : {4, 5}) {
    map.mask(x, 0) = map.mask(x, 1) = 255;
  }
  std::vector<std::int16_t> blocks(3);
  surface_block_row(map.row(0), kFormat, blocks.data());
  // 3 1/3 and 3 1/2 px, in steps of 1/64 px from 10 1/2 px.
  EXPECT_EQ(blocks, (std::vector<std::int16_t>{-459, -448, kNoSurface}));
}

TEST_P(SurfaceBlocks, SurfacesAcrossADepthEdgeHaveNoSay) {
  const auto planes = [](int x, int y) {
    const float slope = 0.04F * static_cast<float>(x) + 0.06F * static_cast<float>(y);
    return x + y / 2 < 25 ? 10 + slope : 15 - slope / 4;
  };
  for (const int radius : {3, 10}) {
    PixelMap map(42, 30, planes);
    fit(map, radius);
    for (int y = 0; y < map.height; ++y) {
      for (int x = 0; x < map.width; ++x) {
        ASSERT_NEAR(map.at(x, y), planes(x, y), 0.05) << x << ", " << y;
      }
    }
  }
}

}  // namespace vantage::kernels::surface_blocks_test
