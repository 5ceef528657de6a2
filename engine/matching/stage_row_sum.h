#pragma once

#include <memory>

#include "scheduler/row_stage.h"

namespace vantage {

/// Aggregation stage: sums over 2·radius + 1 columns, cut to the image (§1). Cells are int32_t,
/// `lanes` (a multiple of kLaneMultiple) a column; exact as long as sums stay within 2³¹ − 1.
/// `number_lanes` adds to each cell the index of its candidate: for inputs that are multiples of a
/// power of two greater than any index, so that the least cell of a column names its winner.
std::unique_ptr<scheduler::RowStage> make_row_sum_stage(int radius, int lanes, bool number_lanes,
                                                        scheduler::Extent extent);

}  // namespace vantage
