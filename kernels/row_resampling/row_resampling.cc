#include "kernels/row_resampling/row_resampling.h"

#include <algorithm>

#include "kernels/keys_weights.h"

namespace vantage::kernels {

void resample_row(const float* row, int width, float fraction, float* values) {
  const KeysWeights weights = keys_weights(fraction);
  const auto sample = [&](float before, float left, float right, float after) {
    const float value = (weights.at[0] * before + weights.at[1] * left) +
                        (weights.at[2] * right + weights.at[3] * after);
    const float min = std::min(std::min(before, left), std::min(right, after));
    const float max = std::max(std::max(before, left), std::max(right, after));
    return std::min(std::max(value, min), max);
  };
  const auto near_border = [&](int x) {
    const auto pixel = [&](int at) { return row[std::clamp(at, 0, width - 1)]; };
    values[x] = sample(pixel(x - 1), pixel(x), pixel(x + 1), pixel(x + 2));
  };
  const int inner_end = std::max(1, width - 2);
  near_border(0);
  for (int x = 1; x < inner_end; ++x) {
    values[x] = sample(row[x - 1], row[x], row[x + 1], row[x + 2]);
  }
  for (int x = inner_end; x < width; ++x) {
    near_border(x);
  }
}

}  // namespace vantage::kernels
