#include "kernels/simd-inl.h"

#include <cstddef>
#include <cstdint>

#include "kernels/machine_ceiling/machine_ceiling.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

double MultiplyAndAdd(std::int64_t rounds, float& sink) {
  const hn::ScalableTag<float> d;
  // Four cycles of latency times two units, plus half as many.
  constexpr int kChains = 12;
  constexpr int kSteps = 16;
  hn::VFromD<decltype(d)> sums[kChains];
  for (int c = 0; c < kChains; ++c) {
    sums[c] = hn::Set(d, static_cast<float>(c));
  }
  const auto factor = hn::Set(d, 0.999F);
  const auto term = hn::Set(d, 1e-3F);
  for (std::int64_t round = 0; round < rounds; ++round) {
#pragma GCC unroll 16
    for (int step = 0; step < kSteps; ++step) {
#pragma GCC unroll 12
      for (auto& sum : sums) {
        sum = hn::MulAdd(sum, factor, term);
      }
    }
  }
  auto all = hn::Zero(d);
  for (const auto& sum : sums) {
    all = hn::Add(all, sum);
  }
  sink = hn::GetLane(hn::SumOfLanes(d, all));
  return 2.0 * static_cast<double>(rounds) * kSteps * kChains * static_cast<double>(hn::Lanes(d));
}

void Triad(float* a, const float* b, const float* c, float s, std::size_t count) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  const auto factor = hn::Set(d, s);
  std::size_t i = 0;
  for (; i + 4 * lanes <= count; i += 4 * lanes) {
#pragma GCC unroll 4
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t at = i + k * lanes;
      hn::StoreU(hn::Add(hn::LoadU(d, b + at), hn::Mul(factor, hn::LoadU(d, c + at))), d, a + at);
    }
  }
  for (; i < count; ++i) {
    a[i] = b[i] + s * c[i];
  }
}

float LoadAll(const float* values, std::size_t count) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  constexpr std::size_t kSums = 8;
  hn::VFromD<decltype(d)> sums[kSums];
  for (auto& sum : sums) {
    sum = hn::Zero(d);
  }
  std::size_t i = 0;
  for (; i + kSums * lanes <= count; i += kSums * lanes) {
#pragma GCC unroll 8
    for (std::size_t k = 0; k < kSums; ++k) {
      sums[k] = hn::Add(sums[k], hn::LoadU(d, values + i + k * lanes));
    }
  }
  auto all = hn::Zero(d);
  for (const auto& sum : sums) {
    all = hn::Add(all, sum);
  }
  float total = hn::GetLane(hn::SumOfLanes(d, all));
  for (; i < count; ++i) {
    total += values[i];
  }
  return total;
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {

HWY_EXPORT(MultiplyAndAdd);
HWY_EXPORT(Triad);
HWY_EXPORT(LoadAll);

double multiply_and_add(std::int64_t rounds, float& sink) {
  return HWY_DYNAMIC_DISPATCH(MultiplyAndAdd)(rounds, sink);
}

void triad(float* a, const float* b, const float* c, float s, std::size_t count) {
  HWY_DYNAMIC_DISPATCH(Triad)(a, b, c, s, count);
}

float load_all(const float* values, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(LoadAll)(values, count);
}

}  // namespace vantage::kernels
#endif  // HWY_ONCE
