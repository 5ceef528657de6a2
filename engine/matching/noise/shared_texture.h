#pragma once

#include <span>

#include "engine/image/disparity_range.h"
#include "engine/image/photograph.h"

namespace vantage {

/// Second differences along and across at column x of the row `centre`: 0 on slopes; the
/// coefficients' squares sum up to 36.
inline float second_difference(const float* up, const float* centre, const float* down, int x) {
  return (up[x - 1] - 2 * up[x] + up[x + 1]) - 2 * (centre[x - 1] - 2 * centre[x] + centre[x + 1]) +
         (down[x - 1] - 2 * down[x] + down[x + 1]);
}

inline constexpr int kNoiseBlockPx = 8;
/// A block of kNoiseBlockPx² pixels, by its upper left one.
struct BlockPlace {
  int x = 0;
  int y = 0;
};

/// Whether the fine structure of these blocks of the left image is found again in the right one:
/// then it is texture. Noise of two images has nothing in common. Rows may differ by one.
bool is_shared_texture(const Photograph& left, const Photograph& right,
                       std::span<const BlockPlace> blocks, DisparityRange disparities);

}  // namespace vantage
