#include "kernels/cell_smoothing/cell_smoothing.h"

#include <cstddef>

namespace vantage::kernels {

void symmetric_sum_ref(const SymmetricSum& sum, float* output) {
  const float* const* middle = sum.runs + sum.radius;
  for (int i = 0; i < sum.count; ++i) {
    output[i] = sum.weights[0] * middle[0][i];
    for (int k = 1; k <= sum.radius; ++k) {
      const float* before = middle[-k];
      const float* after = middle[k];
      if (before != nullptr && after != nullptr) {
        output[i] += sum.weights[k] * (before[i] + after[i]);
      } else if (before != nullptr || after != nullptr) {
        output[i] += sum.weights[k] * (before != nullptr ? before : after)[i];
      }
    }
  }
}

namespace {

// One lane of a cascade. Each function returns the row at column x after one more filter.
struct Lane {
  const BoxCascade& cascade;
  std::ptrdiff_t lane;

  [[nodiscard]] float down(int x) const {
    if (x < cascade.input_begin || x >= cascade.input_end) {
      return 0;
    }
    const std::ptrdiff_t cell =
        static_cast<std::ptrdiff_t>(x - cascade.input_begin) * cascade.lanes + lane;
    const float* cells[2 * BoxCascade::kRadius + 1];
    for (int k = 0; k <= 2 * BoxCascade::kRadius; ++k) {
      cells[k] = cascade.rows[k] == nullptr ? nullptr : cascade.rows[k] + cell;
    }
    float sum = 0;
    symmetric_sum_ref({cells, BoxCascade::kWeights.data(), BoxCascade::kRadius, 1}, &sum);
    return sum;
  }
  [[nodiscard]] float first(int x) const { return down(x - 1) + down(x) + down(x + 1); }
  [[nodiscard]] float second(int x) const { return first(x - 1) + first(x) + first(x + 1); }
  [[nodiscard]] float third(int x) const { return second(x - 1) + second(x) + second(x + 1); }
  [[nodiscard]] float fourth(int x) const {
    return (third(x + 2) + third(x + 1)) + (third(x) + third(x - 1) + third(x - 2));
  }
};

}  // namespace

void box_cascade_row_ref(const BoxCascade& cascade, float* output) {
  for (int x = cascade.output_begin; x < cascade.output_end; ++x) {
    for (int i = 0; i < cascade.lanes; ++i) {
      *output++ = Lane{cascade, i}.fourth(x) * BoxCascade::kUnitGain;
    }
  }
}

}  // namespace vantage::kernels
