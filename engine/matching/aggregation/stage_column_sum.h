#pragma once

#include <memory>

#include "engine/matching/costs/displacement_grid.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Conversion of float costs to integers: (cost + offset) · scale, rounded to nearest.
struct ColumnSumScale {
  float offset = 0;
  float scale = 1;  ///< a power of two
};

/// For costs in [min, max] and windows of window_px × window_px: the offset makes the
/// smallest cost 0; the scale is the largest that keeps costs below 2²² and window sums below 2³¹ −
/// 1.
ColumnSumScale column_sum_scale(float min, float max, int window_px);

/// Converts float costs to int32_t cells, (cost + offset) · scale rounded to nearest (ties to
/// even), and sums them over the 2·radius + 1 rows of a window, cut to the image: the input of
/// make_window_selection_stage() with index_bits = 0. Running integer sums are exact for any first
/// row of a sweep. Cells without a partner are treated as in make_column_ssd_stage(). Costs of
/// cells with a partner must lie in the range passed to column_sum_scale().
std::unique_ptr<scheduler::RowStage> make_column_sum_stage(
    const kernels::CandidateGeometry& geometry, int height, int radius, float offset, float scale);
/// make_column_sum_stage() for the displacements of a grid. Rows whose partner row is outside the
/// image add nothing.
std::unique_ptr<scheduler::RowStage> make_displacement_sum_stage(const DisplacementGrid& grid,
                                                                 int radius, float offset,
                                                                 float scale);

}  // namespace vantage
