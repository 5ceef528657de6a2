#pragma once

#include <cstdint>

#include "kernels/candidates.h"
#include "scheduler/range.h"

namespace vantage {

/// Sets the cells of a row of column sums whose partner is outside the other image to 0, as far as
/// a candidate's window of `radius` columns reaches them; those farther out are left alone. Windows
/// summed over `sums` then hold the samples inside both images only.
/// `sums`: the first candidate's cell of columns.begin, `pitch` cells from column to column.
void clear_without_partner(const kernels::CandidateGeometry& geometry, int radius,
                           scheduler::Range columns, int pitch, std::int32_t* sums);

}  // namespace vantage
