#pragma once

#include "kernels/candidates.h"

namespace vantage::kernels {

/// Position of a candidate's partner relative to its pixel: whole + fraction, 0 ≤ fraction < 1.
struct CandidateShift {
  int whole = 0;
  float fraction = 0;
};

/// Columns whose partners are looked up.
struct InterpolatedColumns {
  int width = 0;
  int first_position = 0;  ///< position in the row for the first column at shift 0
  int position_step = 1;   ///< between columns: +1, or −1 in mirrored rows
  int columns = 0;
  int lanes = 0;
};

/// values[j · lanes + i] = `row` (width floats), interpolated linearly at the position of column j
/// plus shifts[i] (6.6). Positions outside the row take the border value.
void interpolate_candidates(const InterpolatedColumns& columns, const CandidateShift* shifts,
                            const float* row, float* values);

/// Range of candidates among shifts[0..count) (ascending) whose position stays inside a row of
/// `width`, starting from `position`.
CandidateRange candidates_inside(const CandidateShift* shifts, int count, int width, int position);

}  // namespace vantage::kernels
