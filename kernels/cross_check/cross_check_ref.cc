#include "kernels/cross_check/cross_check.h"

#include <cmath>

namespace vantage::kernels {
namespace {

/// other_px(column): the other map.
template <typename Other>
void check_each_column(const CrossCheckRow& row, const Other& other_px) {
  for (int x = 0; x < row.width; ++x) {
    const double own = row.own_px[x];
    const double columns = static_cast<float>(row.direction) * row.columns_per_px * row.own_px[x];
    const double partner = std::floor(x + columns + 0.5);
    bool agrees = false;
    if (partner >= 0 && partner < row.width) {  // false for NaN
      // False when the other map is unknown there.
      agrees = std::abs(own - other_px(static_cast<int>(partner))) < row.tolerance_px;
    }
    row.unmatched[x] = agrees ? 0 : 255;
  }
}

}  // namespace

void cross_check_row_ref(const CrossCheckRow& row, const float* other_px) {
  check_each_column(row, [&](int column) { return static_cast<double>(other_px[column]); });
}

void cross_check_winners_row_ref(const CrossCheckRow& row, const CoarseWinnerRow& other) {
  check_each_column(row, [&](int column) {
    return static_cast<double>(other.winners[column >> other.level] + other.disparity_min) *
           static_cast<double>(other.px_per_candidate);
  });
}

}  // namespace vantage::kernels
