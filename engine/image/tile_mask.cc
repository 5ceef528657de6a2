#include "engine/image/tile_mask.h"

namespace vantage {

using scheduler::Range;
using scheduler::Region;

void TileMask::assign(int width, int height, bool value, int side_px) {
  width_ = width;
  height_ = height;
  side_px_ = side_px;
  columns_ = (width + side_px - 1) / side_px;
  rows_ = (height + side_px - 1) / side_px;
  tiles_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_),
                value ? 1 : 0);
}

std::vector<Region> TileMask::regions() const {
  std::vector<Region> regions;
  std::vector<Region> open;  // those that reach down to the row of tiles before
  std::vector<Region> next;
  for (int row = 0; row < rows_; ++row) {
    next.clear();
    for_each_run(row, true, [&](Range columns) {
      const auto above = std::ranges::find(open, columns, &Region::columns);
      const int begin = above != open.end() ? above->rows.begin : row_pixels(row).begin;
      next.push_back({columns, {begin, row_pixels(row).end}});
    });
    for (const Region& region : open) {
      if (std::ranges::find(next, region.columns, &Region::columns) == next.end()) {
        regions.push_back(region);
      }
    }
    open.swap(next);
  }
  regions.insert(regions.end(), open.begin(), open.end());
  return regions;
}

TileMask TileMask::widened(scheduler::Extent image, int px_per_column, int margin_px,
                           int side_px) const {
  TileMask result(image.columns, image.rows, false, side_px);
  const auto tiles_in = [&](Range pixels, int size) {
    const Range inside =
        Range{pixels.begin / px_per_column, (pixels.end + px_per_column - 1) / px_per_column}
            .widened(margin_px, {0, size});
    return Range{inside.begin / side_px, (inside.end + side_px - 1) / side_px};
  };
  for (int row = 0; row < rows_; ++row) {
    const Range result_rows = tiles_in(row_pixels(row), image.rows);
    for_each_run(row, true, [&](Range columns) {
      const Range result_columns = tiles_in(columns, image.columns);
      for (int y = result_rows.begin; y < result_rows.end; ++y) {
        for (int x = result_columns.begin; x < result_columns.end; ++x) {
          result.set(x, y);
        }
      }
    });
  }
  return result;
}

}  // namespace vantage
