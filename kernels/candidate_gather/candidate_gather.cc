#include "kernels/candidate_gather/candidate_gather.h"

#include <algorithm>
#include <cstdint>

namespace vantage::kernels {

template <typename T>
void gather_candidates(const GatheredColumns& columns, const int* offsets, const T* row,
                       T* values) {
  int sample = columns.first_sample;
  for (int j = 0; j < columns.columns; ++j, sample += columns.column_step) {
    const auto [begin, end] =
        candidates_inside(offsets, columns.lanes, columns.last_sample, sample);
    std::fill(values, values + begin, row[0]);
    for (int i = begin; i < end; ++i) {
      values[i] = row[sample + offsets[i]];
    }
    std::fill(values + end, values + columns.lanes, row[columns.last_sample]);
    values += columns.lanes;
  }
}

template void gather_candidates(const GatheredColumns&, const int*, const std::uint8_t*,
                                std::uint8_t*);
template void gather_candidates(const GatheredColumns&, const int*, const std::uint16_t*,
                                std::uint16_t*);
template void gather_candidates(const GatheredColumns&, const int*, const std::uint32_t*,
                                std::uint32_t*);
template void gather_candidates(const GatheredColumns&, const int*, const float*, float*);

CandidateRange candidates_inside(const int* offsets, int count, int last_sample, int sample) {
  const int* const end = offsets + count;
  const int* const first = std::lower_bound(offsets, end, -sample);
  const int* const after = std::upper_bound(first, end, last_sample - sample);
  return {static_cast<int>(first - offsets), static_cast<int>(after - offsets)};
}

}  // namespace vantage::kernels
