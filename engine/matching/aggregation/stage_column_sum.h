#pragma once

#include <memory>

#include "engine/matching/costs/displacement_grid.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// How float costs become integers: (cost + offset) · scale, rounded to the nearest.
struct ColumnSumScale {
  float offset = 0;
  float scale = 1;  ///< a power of two
};

/// For costs in [least, largest] and windows of window_px × window_px: the offset makes the least
/// cost 0, the scale is the largest for which costs stay below 2²² and sums over windows below
/// 2³¹ − 1.
ColumnSumScale column_sum_scale(float least, float largest, int window_px);

/// Float costs to int32_t cells, (cost + offset) · scale rounded to the nearest (ties to even),
/// summed over the 2·radius + 1 rows of a window, cut to the image: the input of
/// make_window_selection_stage() with index_bits = 0. Integers make running sums exact, whatever
/// row a sweep begins at. Cells without a partner are treated as make_column_ssd_stage() does.
/// Costs of cells with a partner must lie in the range that column_sum_scale() was given.
std::unique_ptr<scheduler::RowStage> make_column_sum_stage(
    const kernels::CandidateGeometry& geometry, int height, int radius, float offset, float scale);
/// The same for the displacements of a grid. Rows whose partner row is outside do not count,
/// either.
std::unique_ptr<scheduler::RowStage> make_displacement_sum_stage(const DisplacementGrid& grid,
                                                                 int radius, float offset,
                                                                 float scale);

}  // namespace vantage
