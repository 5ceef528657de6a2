#pragma once

#include "kernels/candidates.h"

namespace vantage::kernels {

/// Where a candidate's partner lies, relative to its pixel: whole + fraction, 0 ≤ fraction < 1.
struct CandidateShift {
  int whole = 0;
  float fraction = 0;
};

/// The columns whose partners are looked up.
struct InterpolatedColumns {
  int width = 0;
  int first_position = 0;  ///< where in its row a shift of 0 leads from the first column
  int position_step = 1;   ///< from column to column: +1, or −1 in mirrored rows
  int columns = 0;
  int lanes = 0;
};

/// values[j · lanes + i] = `row` (width floats), interpolated linearly at the position of column j
/// plus shifts[i] (6.6); positions outside the row have the value of its border.
void interpolate_candidates(const InterpolatedColumns& columns, const CandidateShift* shifts,
                            const float* row, float* values);

/// The candidates among shifts[0..count), which increase, that stay inside a row of `width` from
/// `position`.
CandidateRange candidates_inside(const CandidateShift* shifts, int count, int width, int position);

}  // namespace vantage::kernels
