#include "kernels/candidate_interpolation/candidate_interpolation.h"

#include <algorithm>

namespace vantage::kernels {

void interpolate_candidates(const InterpolatedColumns& columns, const CandidateShift* shifts,
                            const float* row, float* values) {
  const int last = columns.width - 1;
  int position = columns.first_position;
  for (int j = 0; j < columns.columns; ++j, position += columns.position_step) {
    for (int i = 0; i < columns.lanes; ++i) {
      const int at = position + shifts[i].whole;
      const float before = row[std::clamp(at, 0, last)];
      const float after = row[std::clamp(at + 1, 0, last)];
      *values++ = before + shifts[i].fraction * (after - before);
    }
  }
}

CandidateRange candidates_inside(const CandidateShift* shifts, int count, int width, int position) {
  const CandidateShift* const end = shifts + count;
  const CandidateShift* const first = std::partition_point(
      shifts, end, [&](const CandidateShift& shift) { return position + shift.whole < 0; });
  const CandidateShift* const after =
      std::partition_point(first, end, [&](const CandidateShift& shift) {
        return position + shift.whole + (shift.fraction > 0 ? 1 : 0) < width;
      });
  return {static_cast<int>(first - shifts), static_cast<int>(after - shifts)};
}

}  // namespace vantage::kernels
