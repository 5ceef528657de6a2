#include "engine/matching/costs/cells_without_partner.h"

#include <algorithm>
#include <cstddef>

namespace vantage {

void clear_without_partner(const kernels::CandidateGeometry& geometry, int radius,
                           scheduler::Range columns, int pitch, std::int32_t* sums) {
  if (!geometry.is_of_one()) {
    return;  // all samples count
  }
  radius *= geometry.steps_per_px;
  const auto clear = [&](int x) {
    const kernels::CandidateRange inside = geometry.with_partner(x);
    const int inside_end = std::max(inside.begin, inside.end);
    std::int32_t* cells = sums + static_cast<std::ptrdiff_t>(x - columns.begin) * pitch;
    std::fill(cells + std::max(0, inside.begin - radius), cells + inside.begin, 0);
    std::fill(cells + inside_end, cells + std::min(geometry.count, inside_end + radius), 0);
  };
  // Only columns near the borders have such cells.
  const auto [inner_begin, inner_end] = geometry.columns_with_all_partners();
  int x = columns.begin;
  for (; x < std::min(columns.end, inner_begin); ++x) {
    clear(x);
  }
  for (x = std::max(x, inner_end); x < columns.end; ++x) {
    clear(x);
  }
}

}  // namespace vantage
