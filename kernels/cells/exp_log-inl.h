// Vector form of exp_log.h. Included once per target by dispatched files.

#if defined(VANTAGE_KERNELS_CELLS_EXP_LOG_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VANTAGE_KERNELS_CELLS_EXP_LOG_INL_H_
#undef VANTAGE_KERNELS_CELLS_EXP_LOG_INL_H_
#else
#define VANTAGE_KERNELS_CELLS_EXP_LOG_INL_H_
#endif

#include <cstdint>

#include "kernels/cells/exp_log.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using ExpLogVec = hn::VFromD<hn::ScalableTag<float>>;

// a · b + c with two roundings, as in exp_log.h.
HWY_INLINE ExpLogVec multiply_add(ExpLogVec a, ExpLogVec b, ExpLogVec c) {
  return hn::Add(hn::Mul(a, b), c);
}

HWY_INLINE ExpLogVec exp2_of_negative(ExpLogVec exponent) {
  const hn::ScalableTag<float> df;
  const hn::ScalableTag<std::int32_t> d32;
  const ExpLogVec round = hn::Set(df, kRoundToInteger);
  exponent = hn::Max(exponent, hn::Set(df, kMinExponent));
  const ExpLogVec shifted = hn::Add(exponent, round);
  const ExpLogVec f = hn::Sub(exponent, hn::Sub(shifted, round));
  const auto line = [&](int k) HWY_ATTR {
    return multiply_add(hn::Set(df, kExp2Polynomial[k + 1]), f, hn::Set(df, kExp2Polynomial[k]));
  };
  const ExpLogVec f2 = hn::Mul(f, f);
  const ExpLogVec low = multiply_add(line(2), f2, line(0));
  const ExpLogVec sum = multiply_add(hn::Set(df, kExp2Polynomial[4]), hn::Mul(f2, f2), low);
  const ExpLogVec power = multiply_add(sum, f, hn::Set(df, 1.0F));
  return hn::BitCast(
      df, hn::Add(hn::BitCast(d32, power), hn::ShiftLeft<23>(hn::BitCast(d32, shifted))));
}

HWY_INLINE ExpLogVec log_of_normal(ExpLogVec value) {
  const hn::ScalableTag<float> df;
  const hn::ScalableTag<std::int32_t> d32;
  const auto bits = hn::BitCast(d32, value);
  const auto exponent = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(d32, kRootHalfBits)));
  const ExpLogVec f =
      hn::Sub(hn::BitCast(df, hn::Sub(bits, hn::ShiftLeft<23>(exponent))), hn::Set(df, 1.0F));
  const auto line = [&](int k) HWY_ATTR {
    return multiply_add(hn::Set(df, kLogPolynomial[k + 1]), f, hn::Set(df, kLogPolynomial[k]));
  };
  const ExpLogVec square = hn::Mul(f, f);
  const ExpLogVec low = multiply_add(line(2), square, line(0));
  const ExpLogVec high = multiply_add(hn::Set(df, kLogPolynomial[6]), square, line(4));
  const ExpLogVec sum = multiply_add(high, hn::Mul(square, square), low);
  const ExpLogVec tail =
      hn::Sub(hn::Mul(hn::Mul(sum, f), square), hn::Mul(hn::Set(df, 0.5F), square));
  return multiply_add(hn::ConvertTo(df, exponent), hn::Set(df, kLn2), hn::Add(tail, f));
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
