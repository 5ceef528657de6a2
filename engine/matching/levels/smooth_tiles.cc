#include "engine/matching/levels/smooth_tiles.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <vector>

namespace vantage {
namespace {

using scheduler::Range;

/// Maximum difference of adjacent coarse winners in and around a smooth tile.
constexpr int kSmoothStepPx = 2;
/// Coarse pixels of a tile along one direction.
constexpr int kCoarseSidePx = kLevelTilePx / 2;

/// The coarse pixels in a tile or next to it, along one direction.
Range coarser_pixels_around(int tile, int end) {
  return Range{tile * kCoarseSidePx, (tile + 1) * kCoarseSidePx}.widened(1, {0, end});
}

void find_in_row(ImageView<const std::int32_t> winners, int max_step, int tile_y,
                 TileMask& smooth) {
  const Range rows = coarser_pixels_around(tile_y, winners.height());
  // Per column: the largest difference to the right and below, over the rows.
  const auto width = static_cast<std::size_t>(winners.width());
  std::vector<std::int32_t> right(width);
  std::vector<std::int32_t> below(width);
  for (int y = rows.begin; y < rows.end; ++y) {
    const std::int32_t* const row = winners.row(y);
    const std::int32_t* const next = winners.row(std::min(y + 1, rows.end - 1));
    for (std::size_t x = 0; x + 1 < width; ++x) {
      right[x] = std::max(right[x], std::abs(row[x] - row[x + 1]));
    }
    for (std::size_t x = 0; x < width; ++x) {
      below[x] = std::max(below[x], std::abs(row[x] - next[x]));
    }
  }
  for (int tile_x = 0; tile_x < smooth.columns(); ++tile_x) {
    const Range columns = coarser_pixels_around(tile_x, winners.width());
    const auto first = right.begin() + columns.begin;
    std::int32_t step =
        *std::max_element(below.begin() + columns.begin, below.begin() + columns.end);
    step = std::max(step, *std::max_element(first, first + std::max(1, columns.size() - 1)));
    smooth.set(tile_x, tile_y, step <= max_step);
  }
}

}  // namespace

TileMask smooth_tiles(ImageView<const std::int32_t> coarser_winners, scheduler::Extent extent,
                      int steps_per_px, Execution& execution) {
  TileMask smooth(extent.columns, extent.rows, false, kLevelTilePx);
  execution.for_each_band(smooth.rows(), [&](int first_row, int end_row) {
    for (int tile_y = first_row; tile_y < end_row; ++tile_y) {
      find_in_row(coarser_winners, kSmoothStepPx * steps_per_px, tile_y, smooth);
    }
  });
  return smooth;
}

}  // namespace vantage
