// Weights of two warped images. Included once per target by dispatched files.

#if defined(VANTAGE_KERNELS_BLEND_WEIGHTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VANTAGE_KERNELS_BLEND_WEIGHTS_INL_H_
#undef VANTAGE_KERNELS_BLEND_WEIGHTS_INL_H_
#else
#define VANTAGE_KERNELS_BLEND_WEIGHTS_INL_H_
#endif

#include <cstdint>
#include <limits>

#include "kernels/simd-inl.h"
#include "kernels/view_blend/view_blend.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// Whether the surface at positions [x, x + lanes) continues on both sides; it counts as continuing
// at the row's ends. With several lanes, call only where both sides exist.
template <class D>
HWY_INLINE hn::Mask<D> goes_on(D d, const float* disparity_px, int width, int x, hn::VFromD<D> own,
                               hn::VFromD<D> limit) {
  const auto before = hn::LoadU(d, disparity_px + (x > 0 ? x - 1 : 0));
  const auto after = hn::LoadU(d, disparity_px + (x + 1 < width ? x + 1 : width - 1));
  return hn::And(hn::Le(hn::Abs(hn::Sub(before, own)), limit),
                 hn::Le(hn::Abs(hn::Sub(after, own)), limit));
}

// Computes weights of the left image (0 at holes) and the outputs that do not depend on colour for
// positions [x, x + lanes). Returns the number of holes.
template <class D, typename T>
HWY_INLINE int weigh(D d, const WarpedPairRow& pair, const BlendWeights& weights, int x,
                     const BlendedRow<T>& view, float* HWY_RESTRICT left_weights) {
  const float alpha = weights.alpha;
  const auto left_d = hn::LoadU(d, pair.left_disparity_px + x);
  const auto right_d = hn::LoadU(d, pair.right_disparity_px + x);
  const auto zero = hn::Zero(d);
  const auto one = hn::Set(d, 1.0F);
  const auto limit = hn::Set(d, pair.gradient_limit_px);
  const auto has_left = hn::Eq(left_d, left_d);
  const auto has_right = hn::Eq(right_d, right_d);
  const auto hole = hn::Not(hn::Or(has_left, has_right));

  auto left = hn::Set(d, alpha);
  if (alpha > 0.0F && alpha < 1.0F) {
    if (weights.trust_at_ends != 1.0F) {
      const auto left_on = goes_on(d, pair.left_disparity_px, pair.width, x, left_d, limit);
      const auto right_on = goes_on(d, pair.right_disparity_px, pair.width, x, right_d, limit);
      const auto trust = hn::Set(d, weights.trust_at_ends);
      const auto left_part = hn::Mul(left, hn::IfThenElse(left_on, one, trust));
      const auto right_part = hn::Mul(hn::Sub(one, left), hn::IfThenElse(right_on, one, trust));
      left = hn::IfThenElse(hn::Xor(left_on, right_on),
                            hn::Div(left_part, hn::Add(left_part, right_part)), left);
    }
    const auto same_surface = hn::Le(hn::Abs(hn::Sub(left_d, right_d)), limit);
    const auto nearer = hn::IfThenElse(hn::Gt(left_d, right_d), one, zero);
    left = hn::IfThenElse(same_surface, left, nearer);
  }
  left = hn::IfThenElse(has_right, left, one);
  left = hn::IfThenElse(has_left, left, zero);
  hn::StoreU(left, d, left_weights);

  const auto disparity =
      hn::Add(hn::Mul(left, hn::IfThenElseZero(has_left, left_d)),
              hn::Mul(hn::Sub(one, left), hn::IfThenElseZero(has_right, right_d)));
  const auto unknown = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
  hn::StoreU(hn::IfThenElse(hole, unknown, disparity), d, view.disparity_px + x);

  const hn::Rebind<std::int32_t, D> d32;
  const hn::Rebind<std::uint8_t, D> d8;
  const auto value_where = [d32](hn::Mask<D> mask, std::int32_t value) HWY_ATTR {
    return hn::IfThenElseZero(hn::RebindMask(d32, mask), hn::Set(d32, value));
  };
  hn::StoreU(hn::DemoteTo(d8, value_where(hole, 255)), d8, view.holes + x);
  if (view.sources != nullptr) {
    const auto from_left = value_where(hn::Gt(left, zero), kFromLeft);
    const auto from_right = value_where(hn::AndNot(hole, hn::Lt(left, one)), kFromRight);
    hn::StoreU(hn::DemoteTo(d8, hn::Add(from_left, from_right)), d8, view.sources + x);
  }
  return static_cast<int>(hn::CountTrue(d, hole));
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // VANTAGE_KERNELS_BLEND_WEIGHTS_INL_H_
