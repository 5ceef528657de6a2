// Vector form of keys_weights.h. Included once per target by dispatched files.

#if defined(VANTAGE_KERNELS_KEYS_WEIGHTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VANTAGE_KERNELS_KEYS_WEIGHTS_INL_H_
#undef VANTAGE_KERNELS_KEYS_WEIGHTS_INL_H_
#else
#define VANTAGE_KERNELS_KEYS_WEIGHTS_INL_H_
#endif

#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

template <class D>
struct KeysWeightVectors {
  hn::VFromD<D> at[4];
};

template <class D>
HWY_INLINE KeysWeightVectors<D> keys_weights(D d, hn::VFromD<D> f) {
  const auto half = hn::Set(d, 0.5F);
  const auto one = hn::Set(d, 1.0F);
  const auto half_f = hn::Mul(half, f);
  const auto squared = hn::Mul(f, f);
  const auto inner = hn::Mul(hn::Set(d, 1.5F), f);
  // Mul, Add and Sub, never fused: results must not depend on the instruction set.
  return {{hn::Mul(f, hn::Sub(hn::Mul(f, hn::Sub(one, half_f)), half)),
           hn::Add(hn::Mul(squared, hn::Sub(inner, hn::Set(d, 2.5F))), one),
           hn::Mul(f, hn::Add(hn::Mul(f, hn::Sub(hn::Set(d, 2.0F), inner)), half)),
           hn::Mul(squared, hn::Sub(half_f, half))}};
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // VANTAGE_KERNELS_KEYS_WEIGHTS_INL_H_
