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
  /// A maximal run of connected pixels in a row, and its region.
  struct Run {
    std::int32_t begin = 0;   ///< column
    std::int32_t end = 0;     ///< column after the last
    std::int32_t joined = 0;  ///< an earlier run of the region; the run itself if it is the first
    std::int32_t pixels = 0;  ///< of the region; valid at its first run
  };
  /// One bit per pixel of a row, 64 to a word.
  struct RowBits {
    std::vector<std::uint64_t> matched;
    std::vector<std::uint64_t> joins_right;  ///< connected with the next pixel
    std::vector<std::uint64_t> joins_left;
  };
  std::vector<Run> runs;                ///< row by row, from left to right
  std::vector<std::int32_t> row_begin;  ///< index of each row's first run, and the end of the last
                                        ///< row
  std::array<RowBits, 2> rows;          ///< current row and the one above
  std::vector<std::uint64_t> near;
  std::vector<std::uint64_t> near_y;
};

inline std::size_t held_bytes(const SpeckleWork& work) {
  return held_bytes(work.runs) + held_bytes(work.row_begin);
}

/// Marks as unmatched (255) the matched pixels (0 in `unmatched`) of regions smaller than
/// `min_pixels` (≥ 0). A region is 4-connected over neighbours whose disparities differ by at
/// most 1 px: one surface in the sense of the gradient limit (EQUATIONS §6). Wrong matches that
/// pass the cross-check are small islands, which constant-depth fill would smear into streaks.
/// map_px and unmatched have the same size; pixels with unmatched = 0 are finite. map_y_px: second
/// component of a two-dimensional search, which must agree as well; else empty.
void mark_speckles(ImageView<const float> map_px, ImageView<const float> map_y_px, int min_pixels,
                   SpeckleWork& work, Mask& unmatched);

}  // namespace vantage
