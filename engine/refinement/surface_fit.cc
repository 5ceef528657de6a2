#include "engine/refinement/surface_fit.h"

#include <algorithm>
#include <utility>

#include "kernels/surface_fit/surface_blocks.h"
#include "kernels/surface_fit/surface_fit.h"

namespace vantage {
namespace {

/// Resizes `samples` to a map of this size with margins, and calls fill(y, row) for each row
/// inside; what lies beyond has no surface.
template <typename Fill>
void fill_with_margins(int width, int height, int margin, Execution& execution,
                       Image<std::int16_t>& samples, const Fill& fill) {
  const int after = margin + kernels::kSurfaceRowSlack;
  samples.resize(margin + width + after, margin + height + margin);
  execution.for_each_row(samples.height(), [&](int row) {
    std::int16_t* values = samples.row(row);
    const int y = row - margin;
    if (y < 0 || y >= height) {
      std::fill_n(values, samples.width(), kernels::kNoSurface);
      return;
    }
    std::fill_n(values, margin, kernels::kNoSurface);
    fill(y, values + margin);
    std::fill_n(values + margin + width, after, kernels::kNoSurface);
  });
}

/// The row of samples for a kernel, as fill_with_margins() has laid them out.
kernels::SurfaceRow surface_row(const Image<std::int16_t>& samples, int margin, int y,
                                const kernels::SurfaceFormat& format, int radius_px, int width,
                                DisparityRange search) {
  return {.samples = samples.row(y + margin) + margin,
          .pitch = static_cast<std::ptrdiff_t>(samples.view().stride()),
          .format = format,
          .radius_px = radius_px,
          .width = width,
          .min_px = static_cast<float>(search.min),
          .max_px = static_cast<float>(search.max)};
}

void fit_each_pixel(const Mask& unmatched, int radius_px, DisparityRange search,
                    const TileMask* tiles, Execution& execution, SurfaceFitWork& work,
                    DisparityMap& map_px) {
  const int width = map_px.width();
  const kernels::SurfaceFormat format = kernels::surface_format(search.min, search.max);
  fill_with_margins(
      width, map_px.height(), radius_px, execution, work.samples, [&](int y, std::int16_t* values) {
        kernels::surface_sample_row(map_px.row(y), unmatched.row(y), width, format, values);
      });
  execution.for_each_row(map_px.height(), [&](int y) {
    kernels::SurfaceRow row =
        surface_row(work.samples, radius_px, y, format, radius_px, width, search);
    const std::int16_t* const samples = row.samples;
    for_each_run_in_row(tiles, width, y, [&](scheduler::Range columns) {
      row.samples = samples + columns.begin;
      row.width = columns.size();
      kernels::fit_surface_row(row, map_px.row(y) + columns.begin);
    });
  });
}

void fit_each_block(const Mask& unmatched, int radius_px, DisparityRange search,
                    const TileMask* tiles, Execution& execution, SurfaceFitWork& work,
                    DisparityMap& map_px) {
  const int height = map_px.height();
  const int columns = kernels::surface_blocks(map_px.width());
  const int rows = kernels::surface_blocks(height);
  const int margin = kernels::surface_block_margin(radius_px);
  const kernels::SurfaceFormat format = kernels::surface_format(search.min, search.max);
  const auto pixels = [&](int row) {
    const int upper = 2 * row;
    const int lower = upper + 1;
    const bool has_lower = lower < height;
    return kernels::SurfaceBlockRow{.upper_px = map_px.row(upper),
                                    .lower_px = has_lower ? map_px.row(lower) : nullptr,
                                    .upper_unmatched = unmatched.row(upper),
                                    .lower_unmatched = has_lower ? unmatched.row(lower) : nullptr,
                                    .width = map_px.width()};
  };
  fill_with_margins(columns, rows, margin, execution, work.samples,
                    [&](int row, std::int16_t* values) {
                      kernels::surface_block_row(pixels(row), format, values);
                    });
  execution.for_each_row(rows, [&](int row) {
    const kernels::SurfaceRow blocks =
        surface_row(work.samples, margin, row, format, radius_px, columns, search);
    const kernels::SurfaceBlockRow of_row = pixels(row);
    for_each_run_in_row(tiles, map_px.width(), 2 * row, [&](scheduler::Range run) {
      kernels::SurfaceRow of_run = blocks;
      of_run.samples += run.begin / 2;
      kernels::fit_surface_block_row(
          of_run, of_row.from_block(run.begin / 2, kernels::surface_blocks(run.size())));
    });
  });
}

}  // namespace

void fit_surface(const Mask& unmatched, int radius_px, int step_px, DisparityRange search,
                 Execution& execution, SurfaceFitWork& work, DisparityMap& map_px,
                 const TileMask* tiles) {
  if (step_px == 1) {
    fit_each_pixel(unmatched, radius_px, search, tiles, execution, work, map_px);
  } else {
    fit_each_block(unmatched, radius_px, search, tiles, execution, work, map_px);
  }
}

}  // namespace vantage
