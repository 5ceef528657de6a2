#pragma once

#include <cstdint>

#include "kernels/candidates.h"
#include "scheduler/range.h"

namespace vantage {

/// Zeroes the cells of a row of column sums whose partner is outside the other image and that a
/// candidate's window of `radius` columns reaches; cells farther out are unchanged. Windows summed
/// over `sums` then contain only samples inside both images. With several other images all samples
/// count, and nothing is zeroed.
/// `sums`: the first candidate's cell of columns.begin, `pitch` cells from column to column.
void clear_without_partner(const kernels::CandidateGeometry& geometry, int radius,
                           scheduler::Range columns, int pitch, std::int32_t* sums);

}  // namespace vantage
