#pragma once

#include "kernels/candidates.h"

namespace vantage::kernels {

/// Columns whose partners are looked up one by one, in a row with several samples per pixel.
struct GatheredColumns {
  int last_sample = 0;   ///< of the row; samples are numbered from 0
  int first_sample = 0;  ///< sample of the first column at offset 0
  int column_step = 1;   ///< samples between columns, negative in mirrored rows
  int columns = 0;
  int lanes = 0;
};

/// values[j · lanes + i] = sample first_sample + j · column_step + offsets[i] of `row`. Samples
/// outside take the border value. `offsets` (one per lane) ascend. T is uint8_t, uint16_t, uint32_t
/// or float.
template <typename T>
void gather_candidates(const GatheredColumns& columns, const int* offsets, const T* row, T* values);

/// Range of candidates among offsets[0..count) (ascending) whose sample, from `sample` on, lies
/// inside the row.
CandidateRange candidates_inside(const int* offsets, int count, int last_sample, int sample);

}  // namespace vantage::kernels
