#include "kernels/intensity_sums/intensity_sums.h"

#include <cmath>

namespace vantage::kernels {
namespace {

template <int kLanes>
IntensitySums sums_of(const WarpedPairRow& row) {
  IntensitySums sums;
  for (int x = 0; x < row.width; ++x) {
    // False if either is NaN.
    if (std::abs(row.left_disparity_px[x] - row.right_disparity_px[x]) <= row.gradient_limit_px) {
      ++sums.pixels;
      for (int c = 0; c < kLanes; ++c) {
        const double left = row.left_colours[x * kLanes + c];
        const double right = row.right_colours[x * kLanes + c];
        sums.left[c] += left;
        sums.right[c] += right;
        sums.left_right[c] += left * right;
        sums.left_left[c] += left * left;
      }
    }
  }
  return sums;
}

}  // namespace

void IntensitySums::add(const IntensitySums& other) {
  pixels += other.pixels;
  for (int c = 0; c < 4; ++c) {
    left[c] += other.left[c];
    right[c] += other.right[c];
    left_right[c] += other.left_right[c];
    left_left[c] += other.left_left[c];
  }
}

IntensitySums intensity_sums_row_ref(const WarpedPairRow& row) {
  return row.lanes == 1 ? sums_of<1>(row) : sums_of<4>(row);
}

}  // namespace vantage::kernels
