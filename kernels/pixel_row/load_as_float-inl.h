// Loads values of any pixel type as a vector of floats. Included once per target by dispatched
// files.

#if defined(VANTAGE_KERNELS_LOAD_AS_FLOAT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VANTAGE_KERNELS_LOAD_AS_FLOAT_INL_H_
#undef VANTAGE_KERNELS_LOAD_AS_FLOAT_INL_H_
#else
#define VANTAGE_KERNELS_LOAD_AS_FLOAT_INL_H_
#endif

#include <cstdint>
#include <type_traits>

#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

template <class D, typename T>
HWY_INLINE hn::VFromD<D> load_as_float(D d, const T* values) {
  if constexpr (std::is_same_v<T, float>) {
    return hn::LoadU(d, values);
  } else {
    const hn::Rebind<std::int32_t, D> d32;
    const hn::Rebind<T, D> d_pixel;
    return hn::ConvertTo(d, hn::PromoteTo(d32, hn::LoadU(d_pixel, values)));
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // VANTAGE_KERNELS_LOAD_AS_FLOAT_INL_H_
