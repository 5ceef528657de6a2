// Exponential and logarithm of floats, as exact as float iterations need and no slower; included by
// dispatched files, once per target.

#if defined(VANTAGE_KERNELS_EXP_LOG_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VANTAGE_KERNELS_EXP_LOG_INL_H_
#undef VANTAGE_KERNELS_EXP_LOG_INL_H_
#else
#define VANTAGE_KERNELS_EXP_LOG_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

/// e^x for x ≤ 88; x below −87 gives a value below 2e-38. Relative error below 3e-7.
template <class V>
HWY_INLINE V fast_exp(V x) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::DFromV<V> df;
  const hn::RebindToSigned<decltype(df)> di;
  // 2^(n + f): adding 1.5 · 2²³ rounds to an integer, which then stands in the low bits.
  const V magic = hn::Set(df, 12582912.0F);
  const V scaled = hn::Mul(hn::Max(x, hn::Set(df, -87.3F)), hn::Set(df, 1.44269504F));
  const V shifted = hn::Add(scaled, magic);
  const V f = hn::Sub(scaled, hn::Sub(shifted, magic));
  // 2^f on [−½, ½]: Chebyshev fit, error 8e-8.
  V power = hn::Set(df, 1.339086336E-3F);
  power = hn::MulAdd(power, f, hn::Set(df, 9.676031918E-3F));
  power = hn::MulAdd(power, f, hn::Set(df, 5.550357114E-2F));
  power = hn::MulAdd(power, f, hn::Set(df, 2.402210749E-1F));
  power = hn::MulAdd(power, f, hn::Set(df, 6.931471880E-1F));
  power = hn::MulAdd(power, f, hn::Set(df, 1.000000075F));
  const auto exponent = hn::ShiftLeft<23>(hn::BitCast(di, shifted));
  return hn::BitCast(df, hn::Add(hn::BitCast(di, power), exponent));
}

/// log x for normal x > 0. Absolute error below 3e-7 + 2e-7 |log x|.
template <class V>
HWY_INLINE V fast_log(V x) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::DFromV<V> df;
  const hn::RebindToSigned<decltype(df)> di;
  // x = 2^e · m, m in [√½, √2).
  const auto bits = hn::Sub(hn::BitCast(di, x), hn::Set(di, 0x3F3504F3));
  const V e = hn::ConvertTo(df, hn::ShiftRight<23>(bits));
  const V m =
      hn::BitCast(df, hn::Add(hn::And(bits, hn::Set(di, 0x007FFFFF)), hn::Set(di, 0x3F3504F3)));
  const V t = hn::Sub(m, hn::Set(df, 1.0F));
  // log(1 + t) = t − t²/2 + t³ · q(t): Chebyshev fit of q, error 1.8e-7.
  V q = hn::Set(df, -7.90274377E-2F);
  q = hn::MulAdd(q, t, hn::Set(df, 1.26223198E-1F));
  q = hn::MulAdd(q, t, hn::Set(df, -1.29981838E-1F));
  q = hn::MulAdd(q, t, hn::Set(df, 1.42144959E-1F));
  q = hn::MulAdd(q, t, hn::Set(df, -1.66412815E-1F));
  q = hn::MulAdd(q, t, hn::Set(df, 2.00010451E-1F));
  q = hn::MulAdd(q, t, hn::Set(df, -2.50003064E-1F));
  q = hn::MulAdd(q, t, hn::Set(df, 3.33333307E-1F));
  const V t2 = hn::Mul(t, t);
  V tail = hn::MulAdd(hn::Mul(t2, t), q, hn::Mul(t2, hn::Set(df, -0.5F)));
  tail = hn::Add(tail, t);
  return hn::MulAdd(e, hn::Set(df, 0.693147181F), tail);
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
