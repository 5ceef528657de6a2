#include "kernels/simd-inl.h"

#include <cmath>

#include "kernels/cells/exp_log-inl.h"
#include "kernels/cells/exp_log.h"
#include "kernels/edge_weights/edge_weights.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

void edge_weights(const float* first, const float* second, int count, const EdgeModel& model,
                  float* weights) {
  const hn::ScalableTag<float> df;
  const int step = static_cast<int>(hn::Lanes(df));
  const auto exponent_of_level = hn::Set(df, -kLog2E / model.contrast);
  const auto min = hn::Set(df, model.min);
  const auto rest = hn::Set(df, 1.0F - model.min);
  int x = 0;
  for (; x + step <= count; x += step) {
    const auto difference = hn::AbsDiff(hn::LoadU(df, first + x), hn::LoadU(df, second + x));
    const auto power = exp2_of_negative(hn::Mul(difference, exponent_of_level));
    hn::StoreU(hn::Add(hn::Mul(rest, power), min), df, weights + x);
  }
  edge_weights_row_ref(first + x, second + x, count - x, model, weights + x);
}

void fixed_weights(const float* weights, int count, float factor, FixedWeight* fixed) {
  const hn::ScalableTag<float> df;
  const hn::Rebind<FixedWeight, decltype(df)> d16;
  const int step = static_cast<int>(hn::Lanes(df));
  if (count < step) {
    fixed_weights_row_ref(weights, count, factor, fixed);
    return;
  }
  const auto scale = hn::Set(df, factor * kFixedWeightUnits);
  const auto make = [&](int x) HWY_ATTR {
    const auto units = hn::NearestInt(hn::Mul(hn::LoadU(df, weights + x), scale));
    hn::StoreU(hn::DemoteTo(d16, units), d16, fixed + x);  // saturates
  };
  for (int x = 0; x + step <= count; x += step) {
    make(x);
  }
  make(count - step);  // the rest; recomputes some values
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(edge_weights);
HWY_EXPORT(fixed_weights);

void edge_weights_row(const float* first, const float* second, int count, const EdgeModel& model,
                      float* weights) {
  HWY_DYNAMIC_DISPATCH(edge_weights)(first, second, count, model, weights);
}
void fixed_weights_row(const float* weights, int count, float factor, FixedWeight* fixed) {
  HWY_DYNAMIC_DISPATCH(fixed_weights)(weights, count, factor, fixed);
}

// Scalar reference.

void edge_weights_row_ref(const float* first, const float* second, int count,
                          const EdgeModel& model, float* weights) {
  const float exponent_of_level = -kLog2E / model.contrast;
  const float rest = 1.0F - model.min;
  for (int x = 0; x < count; ++x) {
    const float difference = std::abs(first[x] - second[x]);
    weights[x] = rest * exp2_of_negative(difference * exponent_of_level) + model.min;
  }
}

void fixed_weights_row_ref(const float* weights, int count, float factor, FixedWeight* fixed) {
  for (int x = 0; x < count; ++x) {
    fixed[x] = fixed_weight(weights[x] * factor);
  }
}

}  // namespace vantage::kernels
#endif
