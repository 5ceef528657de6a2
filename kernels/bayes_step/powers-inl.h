// Powers and logarithms of Bayesian diffusion for vectors. They take fewer steps than exp_log-inl.h
// and use fused operations where available. Included once per target by dispatched files. Both
// polynomials are minimax fits for these functions.

#if defined(VANTAGE_KERNELS_BAYES_STEP_POWERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VANTAGE_KERNELS_BAYES_STEP_POWERS_INL_H_
#undef VANTAGE_KERNELS_BAYES_STEP_POWERS_INL_H_
#else
#define VANTAGE_KERNELS_BAYES_STEP_POWERS_INL_H_
#endif

#include <cstdint>

#include "kernels/cells/exp_log.h"
#include "kernels/cells/lane_sums-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using PowerBits = hn::RebindToSigned<FloatTag>;

// 2^exponent, relative error below 3.2e-6, for exponents ≤ 0 (or above by rounding only). kClamped:
// exponents below kMinExponent are clamped to it; otherwise there must be none.
template <bool kClamped>
HWY_INLINE FloatVec power_of_two(FloatVec exponent) {
  const FloatTag df;
  const PowerBits d32;
  const auto c = [df](float value) HWY_ATTR { return hn::Set(df, value); };
  if constexpr (kClamped) {
    exponent = hn::Max(exponent, c(kMinExponent));
  }
  // 2^f = 1 + f · (…), f in [−½, ½]; relative error of the fit 2.8e-6.
  const FloatVec shifted = hn::Add(exponent, c(kRoundToInteger));
  const FloatVec f = hn::Sub(exponent, hn::Sub(shifted, c(kRoundToInteger)));
  const FloatVec low = hn::MulAdd(c(0.240240991F), f, c(0.693124175F));
  const FloatVec high = hn::MulAdd(c(0.00958285294F), f, c(0.0559064262F));
  const FloatVec power = hn::MulAdd(hn::MulAdd(high, hn::Mul(f, f), low), f, c(1.0F));
  return hn::BitCast(
      df, hn::Add(hn::BitCast(d32, power), hn::ShiftLeft<23>(hn::BitCast(d32, shifted))));
}

// factor · log₂ of normal floats; error below |factor| · 5e-7 · max(1, |log₂|).
class ScaledLogarithm {
 public:
  explicit ScaledLogarithm(float factor) {
    for (int k = 0; k < kTerms; ++k) {
      terms_[k] = hn::Set(FloatTag(), factor * kPolynomial[k]);
    }
    // For exponents left in place among the bits of the float.
    exponent_ = hn::Set(FloatTag(), factor * 0x1p-23F);
  }

  HWY_INLINE FloatVec of(FloatVec value) const {
    const FloatTag df;
    const PowerBits d32;
    const auto bits = hn::BitCast(d32, value);
    const auto exponent = hn::And(hn::Sub(bits, hn::Set(d32, kRootHalfBits)),
                                  hn::Set(d32, static_cast<std::int32_t>(0xFF800000)));
    const FloatVec f = hn::Sub(hn::BitCast(df, hn::Sub(bits, exponent)), hn::Set(df, 1.0F));
    const FloatVec f2 = hn::Mul(f, f);
    const FloatVec low = hn::MulAdd(line(f, 2), f2, line(f, 0));
    const FloatVec high = hn::MulAdd(terms_[6], f2, line(f, 4));
    const FloatVec sum = hn::MulAdd(high, hn::Mul(f2, f2), low);
    return hn::MulAdd(sum, f, hn::Mul(hn::ConvertTo(df, exponent), exponent_));
  }

 private:
  // log₂(1 + f) = f · (…), 1 + f in [√½, √2]; error of the fit 3.0e-7.
  static constexpr int kTerms = 7;
  static constexpr float kPolynomial[kTerms] = {1.44269967F,  -0.721375883F, 0.480465025F,
                                                -0.35896185F, 0.297262579F,  -0.272697926F,
                                                0.170634508F};

  [[nodiscard]] HWY_INLINE FloatVec line(FloatVec f, int k) const {
    return hn::MulAdd(terms_[k + 1], f, terms_[k]);
  }

  FloatVec terms_[kTerms];
  FloatVec exponent_;
};

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
