#include "kernels/simd-inl.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "kernels/flicker_sums/flicker_sums.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

template <class D, class Operation>
HWY_INLINE auto joined(D d, hn::VFromD<D> v, Operation operation) {
  HWY_ALIGN hn::TFromD<D> lanes[hn::MaxLanes(D())];
  hn::Store(v, d, lanes);
  return operation(lanes, lanes + hn::Lanes(d));
}

template <class D>
HWY_INLINE std::int64_t sum_of(D d, hn::VFromD<D> v) {
  return joined(d, v, [](const auto* begin, const auto* end) {
    std::int64_t sum = 0;
    for (; begin != end; ++begin) {
      sum += *begin;
    }
    return sum;
  });
}

/// Columns [begin, end), a whole number of vectors, few enough for 32-bit sums.
HWY_INLINE void add_disparity_change(const float* HWY_RESTRICT now,
                                     const float* HWY_RESTRICT before,
                                     const std::uint8_t* HWY_RESTRICT mask, int begin, int end,
                                     DisparityChange& sums) {
  const hn::ScalableTag<float> d;
  const hn::ScalableTag<std::int32_t> di;
  const hn::Rebind<std::uint8_t, decltype(d)> d8;
  const auto infinity = hn::Set(d, std::numeric_limits<float>::infinity());
  const auto one = hn::Set(d, 1.0F);
  const auto units = hn::Set(d, 1024.0F);
  auto min = infinity;
  auto max = hn::Neg(infinity);
  auto compared = hn::Zero(di);
  auto jumped = hn::Zero(di);
  auto change = hn::Zero(di);
  for (int x = begin; x < end; x += static_cast<int>(hn::Lanes(d))) {
    const auto a = hn::LoadU(d, now + x);
    const auto b = hn::LoadU(d, before + x);
    const auto known_a = hn::Eq(a, a);
    const auto known_b = hn::Eq(b, b);
    min = hn::Min(
        min, hn::Min(hn::IfThenElse(known_a, a, infinity), hn::IfThenElse(known_b, b, infinity)));
    max = hn::Max(max, hn::Max(hn::IfThenElse(known_a, a, hn::Neg(infinity)),
                               hn::IfThenElse(known_b, b, hn::Neg(infinity))));
    const auto difference = hn::Abs(hn::Sub(a, b));
    const auto masked =
        hn::RebindMask(d, hn::Ne(hn::PromoteTo(di, hn::LoadU(d8, mask + x)), hn::Zero(di)));
    const auto counts = hn::And(masked, hn::Eq(difference, difference));
    const auto counted = hn::IfThenElseZero(counts, difference);
    // −1 where true.
    compared = hn::Sub(compared, hn::VecFromMask(di, hn::RebindMask(di, counts)));
    jumped = hn::Sub(jumped, hn::VecFromMask(di, hn::RebindMask(di, hn::Gt(counted, one))));
    change = hn::Add(change, hn::ConvertTo(di, hn::Add(hn::Mul(hn::Min(counted, units), units),
                                                       hn::Set(d, 0.5F))));
  }
  sums.compared += sum_of(di, compared);
  sums.jumped += sum_of(di, jumped);
  sums.change += sum_of(di, change);
  sums.min_px = std::min(sums.min_px, joined(d, min, [](const float* a, const float* z) {
                           return *std::min_element(a, z);
                         }));
  sums.max_px = std::max(sums.max_px, joined(d, max, [](const float* a, const float* z) {
                           return *std::max_element(a, z);
                         }));
}

DisparityChange disparity_change(const float* now, const float* before, const std::uint8_t* mask,
                                 int width) {
  constexpr int kPiece = 1024;  // 2^10 columns of 2^20 units stay below 2^31
  const int whole = width - width % static_cast<int>(hn::Lanes(hn::ScalableTag<float>()));
  DisparityChange sums =
      disparity_change_row_ref(now + whole, before + whole, mask + whole, width - whole);
  for (int x = 0; x < whole; x += kPiece) {
    add_disparity_change(now, before, mask, x, std::min(x + kPiece, whole), sums);
  }
  return sums;
}

/// Sums bytes; 16-bit lanes can hold the sum of 256 bytes.
class ByteSum {
 public:
  using D = hn::ScalableTag<std::uint16_t>;
  static constexpr int kStep = static_cast<int>(hn::MaxLanes(D()));
  static constexpr int kMaxSteps = 256;

  HWY_INLINE ByteSum() : lanes_(hn::Zero(D())) {}
  HWY_INLINE void add(hn::VFromD<hn::Rebind<std::uint8_t, D>> bytes) {
    lanes_ = hn::Add(lanes_, hn::PromoteTo(D(), bytes));
  }
  HWY_INLINE std::int64_t sum() const { return sum_of(D(), lanes_); }

 private:
  hn::VFromD<D> lanes_;
};
using TagOfBytes = hn::Rebind<std::uint8_t, ByteSum::D>;

IntensityChange intensity_change(const std::uint8_t* HWY_RESTRICT now,
                                 const std::uint8_t* HWY_RESTRICT before,
                                 const std::uint8_t* HWY_RESTRICT mask, int width) {
  const TagOfBytes d8;
  const int whole = width - width % ByteSum::kStep;
  IntensityChange sums =
      intensity_change_row_ref(now + whole, before + whole, mask + whole, width - whole);
  for (int x = 0; x < whole;) {
    const int end = std::min(whole, x + ByteSum::kMaxSteps * ByteSum::kStep);
    ByteSum compared;
    ByteSum change;
    for (; x < end; x += ByteSum::kStep) {
      const auto a = hn::LoadU(d8, now + x);
      const auto b = hn::LoadU(d8, before + x);
      const auto counts = hn::LoadU(d8, mask + x);
      const auto difference = hn::Sub(hn::Max(a, b), hn::Min(a, b));
      change.add(hn::And(difference, counts));
      compared.add(hn::And(counts, hn::Set(d8, 1)));
    }
    sums.compared += compared.sum();
    sums.change += change.sum();
  }
  return sums;
}

std::int64_t intensity_sum(const std::uint8_t* levels, int width) {
  const TagOfBytes d8;
  const int whole = width - width % ByteSum::kStep;
  std::int64_t total = intensity_sum_row_ref(levels + whole, width - whole);
  for (int x = 0; x < whole;) {
    const int end = std::min(whole, x + ByteSum::kMaxSteps * ByteSum::kStep);
    ByteSum sum;
    for (; x < end; x += ByteSum::kStep) {
      sum.add(hn::LoadU(d8, levels + x));
    }
    total += sum.sum();
  }
  return total;
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(disparity_change);
HWY_EXPORT(intensity_change);
HWY_EXPORT(intensity_sum);

DisparityChange disparity_change_row(const float* now_px, const float* before_px,
                                     const std::uint8_t* mask, int width) {
  return HWY_DYNAMIC_DISPATCH(disparity_change)(now_px, before_px, mask, width);
}
IntensityChange intensity_change_row(const std::uint8_t* now, const std::uint8_t* before,
                                     const std::uint8_t* mask, int width) {
  return HWY_DYNAMIC_DISPATCH(intensity_change)(now, before, mask, width);
}
std::int64_t intensity_sum_row(const std::uint8_t* levels, int width) {
  return HWY_DYNAMIC_DISPATCH(intensity_sum)(levels, width);
}

// Scalar reference.

DisparityChange disparity_change_row_ref(const float* now_px, const float* before_px,
                                         const std::uint8_t* mask, int width) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kMax = 1024;
  constexpr float kUnitsPerPixel = 1024;
  DisparityChange sums{.min_px = kInfinity, .max_px = -kInfinity};
  for (int x = 0; x < width; ++x) {
    for (const float d : {now_px[x], before_px[x]}) {
      if (!std::isnan(d)) {
        sums.min_px = std::min(sums.min_px, d);
        sums.max_px = std::max(sums.max_px, d);
      }
    }
    const float change = std::abs(now_px[x] - before_px[x]);
    if (mask[x] != 0 && !std::isnan(change)) {
      ++sums.compared;
      sums.jumped += change > 1 ? 1 : 0;
      sums.change += static_cast<std::int64_t>(std::min(change, kMax) * kUnitsPerPixel + 0.5F);
    }
  }
  return sums;
}

IntensityChange intensity_change_row_ref(const std::uint8_t* now, const std::uint8_t* before,
                                         const std::uint8_t* mask, int width) {
  IntensityChange sums;
  for (int x = 0; x < width; ++x) {
    if (mask[x] != 0) {
      ++sums.compared;
      sums.change += std::abs(now[x] - before[x]);
    }
  }
  return sums;
}

std::int64_t intensity_sum_row_ref(const std::uint8_t* levels, int width) {
  std::int64_t sum = 0;
  for (int x = 0; x < width; ++x) {
    sum += levels[x];
  }
  return sum;
}

}  // namespace vantage::kernels
#endif
