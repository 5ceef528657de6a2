// Natural logarithm that is identical on every instruction set. Included once per target by
// dispatched files.

#if defined(VANTAGE_KERNELS_LOGARITHM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VANTAGE_KERNELS_LOGARITHM_INL_H_
#undef VANTAGE_KERNELS_LOGARITHM_INL_H_
#else
#define VANTAGE_KERNELS_LOGARITHM_INL_H_
#endif

#include <cstdint>

#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// log x for positive normal doubles, accurate to a few units in the last place. (Highway's version
// fuses multiplications and additions where it can, so it differs between instruction sets.)
template <class D64>
HWY_INLINE auto natural_logarithm(D64 d64, hn::VFromD<D64> x) {
  const hn::Rebind<std::int64_t, D64> di64;
  // x = m · 2^e with √½ ≤ m < √2: subtracting the bits of √½ leaves e above the fraction.
  const auto bits = hn::BitCast(di64, x);
  const auto e = hn::ShiftRight<52>(hn::Sub(bits, hn::Set(di64, 0x3FE6A09E667F3BCD)));
  const auto m = hn::BitCast(d64, hn::Sub(bits, hn::ShiftLeft<52>(e)));
  // log m = 2 artanh s = 2s (1 + s²/3 + s⁴/5 + …) with |s| < 0.172.
  const auto one = hn::Set(d64, 1.0);
  const auto s = hn::Div(hn::Sub(m, one), hn::Add(m, one));
  const auto square = hn::Mul(s, s);
  constexpr double coefficients[] = {1. / 19, 1. / 17, 1. / 15, 1. / 13, 1. / 11,
                                     1. / 9,  1. / 7,  1. / 5,  1. / 3,  1.};
  auto series = hn::Set(d64, 1. / 21);
#pragma GCC unroll 10
  for (const double coefficient : coefficients) {
    series = hn::Add(hn::Mul(series, square), hn::Set(d64, coefficient));
  }
  constexpr double log_2 = 0.693147180559945309417;
  return hn::Add(hn::Mul(hn::ConvertTo(d64, e), hn::Set(d64, log_2)),
                 hn::Mul(hn::Add(s, s), series));
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
