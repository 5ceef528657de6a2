#include "engine/synthesis/surface_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "kernels/known_range/known_range.h"
#include "kernels/surface_splat/surface_splat.h"

namespace vantage {
namespace {

// A band of the view processes the tiles of the image that can reach it.
constexpr int kTileColumns = 64;
constexpr int kTileRows = 16;

// Bands with fewer lines would process most tiles twice; a few bands per thread balance the load.
constexpr int kMinBandLines = 64;
constexpr int kBandsPerThread = 4;
constexpr std::int64_t kMaxBandPixels = std::int64_t{1} << 30;

int tiles_in(int size, int tile_size) { return (size + tile_size - 1) / tile_size; }

/// Lines of the view that the pixels of a tile, and the gaps after them, can be mapped to.
struct Reach {
  int first_line = 0;
  int end_line = 0;  ///< empty if not above first_line
};

/// Range of positions and disparities, bounds included.
struct PositionBox {
  double first_x;
  double last_x;
  double first_y;
  double last_y;
  kernels::KnownRange disparity_px;
};

// u and v are quotients of linear functions of x, y and d: for λ > 0 their extremes are at corners
// of the box.
Reach reach_of(const PositionBox& box, const kernels::ViewProjection& view,
               ImageView<const float> target) {
  if (!(box.disparity_px.min <= box.disparity_px.max)) {
    return {};
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double min_u = kInfinity;
  double max_u = -kInfinity;
  double min_v = kInfinity;
  double max_v = -kInfinity;
  int after = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const kernels::ExactTarget at =
        kernels::exact_target(view, (corner & 1) != 0 ? box.last_x : box.first_x,
                              (corner & 2) != 0 ? box.last_y : box.first_y,
                              (corner & 4) != 0 ? box.disparity_px.max : box.disparity_px.min);
    after += at.depth_ratio > kernels::kMinDepthRatio ? 0 : 1;
    min_u = std::min(min_u, at.u);
    max_u = std::max(max_u, at.u);
    min_v = std::min(min_v, at.v);
    max_v = std::max(max_v, at.v);
  }
  if (after == 8) {
    return {};
  }
  if (after > 0) {
    return {.first_line = 0, .end_line = target.height()};
  }
  constexpr double kMargin = 2;  // rounding to whole pixels, and rounding errors
  if (max_u < -kMargin || min_u > target.width() + kMargin) {
    return {};
  }
  const auto limited = [&](double line) {
    return static_cast<int>(std::clamp(line, 0.0, 1.0 * target.height()));
  };
  return {.first_line = limited(std::floor(min_v - kMargin)),
          .end_line = limited(std::ceil(max_v + kMargin))};
}

/// Memory for two rows of projected pixels.
class ProjectedRows {
 public:
  static std::size_t bytes(int width) { return 8 * sizeof(float) * floats(width); }

  ProjectedRows(std::byte* memory, int width) {
    const auto next = [&] { return std::exchange(memory, memory + sizeof(float) * floats(width)); };
    for (kernels::ProjectedRow* row : {&upper, &lower}) {
      row->disparity_px = reinterpret_cast<float*>(next());
      row->nearness = reinterpret_cast<float*>(next());
      row->column = reinterpret_cast<std::int32_t*>(next());
      row->line = reinterpret_cast<std::int32_t*>(next());
    }
  }

  kernels::ProjectedRow upper;
  kernels::ProjectedRow lower;

 private:
  // One more pixel on either side, both invalid.
  static std::size_t floats(int width) {
    return static_cast<std::size_t>(width + 2 + kernels::kSplatPadding);
  }
};

class SurfaceMapper {
 public:
  SurfaceMapper(ImageView<const float> disparity_px, const kernels::ViewProjection& view,
                float gradient_limit_px, ImageView<float> nearness, Execution& execution)
      : disparity_px_(disparity_px),
        view_(view),
        gradient_limit_px_(gradient_limit_px),
        nearness_(nearness),
        execution_(execution),
        border_px_(view.is_translation ? 0 : 1),
        tile_columns_(tiles_in(disparity_px.width(), kTileColumns)),
        tile_rows_(tiles_in(disparity_px.height(), kTileRows)),
        reaches_memory_(execution.scratch().lease(
            surface_map_bytes(disparity_px.width(), disparity_px.height()))),
        reaches_(reinterpret_cast<Reach*>(reaches_memory_.data())) {}

  void run() {
    execution_.executor().parallel_for(tile_rows_, [&](int row) { find_reaches(row); });
    const int lines = band_lines();
    execution_.executor().parallel_for(tiles_in(nearness_.height(), lines), [&](int band) {
      map_band(band * lines, std::min((band + 1) * lines, nearness_.height()));
    });
  }

 private:
  [[nodiscard]] Reach& reach(int tile_row, int tile_column) const {
    return reaches_[tile_row * tile_columns_ + tile_column];
  }

  [[nodiscard]] int band_lines() const {
    const int threads = execution_.executor().thread_count();
    const int bands = threads == 1 ? 1 : kBandsPerThread * threads;
    return static_cast<int>(
        std::min<std::int64_t>(std::max(kMinBandLines, tiles_in(nearness_.height(), bands)),
                               kMaxBandPixels / static_cast<std::int64_t>(nearness_.stride())));
  }

  void find_reaches(int tile_row) {
    // One more pixel to the right and below, because gaps reach that far. Torn surfaces extend half
    // a pixel beyond the image.
    const double beyond = 0.5 * border_px_;
    const int first_y = tile_row * kTileRows;
    const int last_y = std::min(first_y + kTileRows, disparity_px_.height() - 1);
    for (int column = 0; column < tile_columns_; ++column) {
      const int first_x = column * kTileColumns;
      const int last_x = std::min(first_x + kTileColumns, disparity_px_.width() - 1);
      PositionBox box{.first_x = first_x - beyond,
                      .last_x = last_x + beyond,
                      .first_y = first_y - beyond,
                      .last_y = last_y + beyond,
                      .disparity_px = {}};
      for (int y = first_y; y <= last_y; ++y) {
        box.disparity_px = kernels::known_range_row(disparity_px_.row(y) + first_x,
                                                    last_x - first_x + 1, box.disparity_px);
      }
      reach(tile_row, column) = reach_of(box, view_, nearness_);
    }
  }

  void map_band(int first_line, int end_line) {
    for (int line = first_line; line < end_line; ++line) {
      std::fill_n(nearness_.row(line), nearness_.width(), -std::numeric_limits<float>::infinity());
    }
    const kernels::SplatBand band{.nearness = nearness_.row(first_line),
                                  .stride = static_cast<std::ptrdiff_t>(nearness_.stride()),
                                  .width = nearness_.width(),
                                  .first_line = first_line,
                                  .lines = end_line - first_line};
    const auto memory = execution_.scratch().lease(ProjectedRows::bytes(disparity_px_.width()));
    ProjectedRows rows(memory.data(), disparity_px_.width());
    for (int tile_row = 0; tile_row < tile_rows_; ++tile_row) {
      const auto reaches_band = [&](int column) {
        const Reach& at = reach(tile_row, column);
        return at.first_line < end_line && at.end_line > first_line;
      };
      int column = 0;
      while (column < tile_columns_) {
        const int begin = column;
        while (column < tile_columns_ && reaches_band(column)) {
          ++column;
        }
        if (column > begin) {
          map_tiles(tile_row, begin, column, rows, band);
        }
        ++column;
      }
    }
  }

  // Maps the tiles [begin, end) of a row of tiles.
  void map_tiles(int tile_row, int begin, int end, ProjectedRows& rows,
                 const kernels::SplatBand& band) {
    // Quads before the first column and row belong to the tiles there.
    const int first_x = begin == 0 ? -border_px_ : begin * kTileColumns;
    const int count = std::min(end * kTileColumns, disparity_px_.width()) - first_x;
    const int first_y = tile_row == 0 ? -border_px_ : tile_row * kTileRows;
    const int end_y = std::min((tile_row + 1) * kTileRows, disparity_px_.height());
    const double centre_x = 0.5 * (disparity_px_.width() - 1);
    const double centre_y = 0.5 * (disparity_px_.height() - 1);
    kernels::SplatRows splat{.view = view_,
                             .upper = {},
                             .lower = {},
                             .count = count,
                             .first_column = first_x,
                             .right_edge = kernels::right_edge_direction(view_, centre_x, centre_y),
                             .lower_edge = kernels::lower_edge_direction(view_, centre_x, centre_y),
                             .gradient_limit_px = gradient_limit_px_};
    project(first_x, count, first_y, rows.upper);
    for (int y = first_y; y < end_y; ++y) {
      project(first_x, count, y + 1, rows.lower);
      splat.upper = rows.upper;
      splat.lower = rows.lower;
      splat.line = y;
      kernels::splat_rows(splat, band);
      std::swap(rows.upper, rows.lower);
    }
  }

  // Projects pixels first_x … first_x + count of row y; those outside the image are invalid.
  void project(int first_x, int count, int y, const kernels::ProjectedRow& row) {
    const bool has_row = y >= 0 && y < disparity_px_.height();
    const int before = has_row ? std::max(-first_x, 0) : count + 1;
    const int end = std::min(count + 1, disparity_px_.width() - first_x);
    const auto fill_missing = [&](int first, int number) {
      std::fill_n(row.disparity_px + first, number, std::numeric_limits<float>::quiet_NaN());
      std::fill_n(row.nearness + first, number, -std::numeric_limits<float>::infinity());
      std::fill_n(row.column + first, number, 0);
      std::fill_n(row.line + first, number, 0);
    };
    fill_missing(0, before);
    if (has_row) {
      kernels::project_row(view_,
                           {.disparity_px = disparity_px_.row(y) + first_x + before,
                            .count = end - before,
                            .first_column = first_x + before,
                            .line = y},
                           {.disparity_px = row.disparity_px + before,
                            .nearness = row.nearness + before,
                            .column = row.column + before,
                            .line = row.line + before});
      fill_missing(end, count + 1 - end);
    }
  }

  ImageView<const float> disparity_px_;
  const kernels::ViewProjection& view_;
  float gradient_limit_px_;
  ImageView<float> nearness_;
  Execution& execution_;
  int border_px_;  // pixels around the image at which quads are formed
  int tile_columns_;
  int tile_rows_;
  scheduler::ScratchPool::Lease reaches_memory_;
  Reach* reaches_;
};

}  // namespace

std::size_t surface_map_bytes(int source_width, int source_height) {
  return sizeof(Reach) * static_cast<std::size_t>(tiles_in(source_width, kTileColumns)) *
         static_cast<std::size_t>(tiles_in(source_height, kTileRows));
}

void map_surfaces(ImageView<const float> disparity_px, const kernels::ViewProjection& view,
                  float gradient_limit_px, ImageView<float> nearness, Execution& execution) {
  SurfaceMapper(disparity_px, view, gradient_limit_px, nearness, execution).run();
}

}  // namespace vantage
