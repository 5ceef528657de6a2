#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/image/image.h"
#include "engine/image/memory_use.h"

namespace vantage {

/// Working memory of mark_speckles(), reused from call to call.
struct SpeckleWork {
  /// Neighbouring pixels of a row that are connected, as many as there are; and the region that
  /// they are part of.
  struct Run {
    std::int32_t begin = 0;   ///< column
    std::int32_t end = 0;     ///< column behind the last
    std::int32_t joined = 0;  ///< an earlier run of the region; the run itself if it is the first
    std::int32_t pixels = 0;  ///< of the region, at its first run
  };
  /// A row's answers for each of its pixels, 64 to a word.
  struct RowBits {
    std::vector<std::uint64_t> matched;
    std::vector<std::uint64_t> joins_right;  ///< connected with the next pixel
    std::vector<std::uint64_t> joins_left;
  };
  std::vector<Run> runs;                ///< row by row, from left to right
  std::vector<std::int32_t> row_begin;  ///< of each row and behind the last: index of its first run
  std::array<RowBits, 2> rows;          ///< this one and the one above
  std::vector<std::uint64_t> near;
  std::vector<std::uint64_t> near_y;
};

inline std::size_t held_bytes(const SpeckleWork& work) {
  return held_bytes(work.runs) + held_bytes(work.row_begin);
}

/// Marks as unmatched (255) the matched pixels (0 in `unmatched`) of regions smaller than
/// `least_pixels`, which is ≥ 0. A region is connected over its 4-neighbours whose disparities
/// differ by at most 1 px, one surface in the sense of the gradient limit (EQUATIONS §6). Wrong
/// matches that the cross-check lets through are small islands; constant-depth fill would draw them
/// out into streaks. map_px and unmatched have the same size; pixels with unmatched = 0 are finite.
/// Of a two-dimensional search map_y_px holds the second component, in which neighbours must agree
/// as well; else it is empty.
void mark_speckles(ImageView<const float> map_px, ImageView<const float> map_y_px, int least_pixels,
                   SpeckleWork& work, Mask& unmatched);

}  // namespace vantage
