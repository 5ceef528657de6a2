#include "kernels/simd-inl.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/view_projection/view_projection.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// Converts floor(target + ½), computed by the caller, to a clamped integer.
template <class D64, class V = hn::VFromD<D64>>
HWY_INLINE hn::VFromD<hn::Rebind<std::int32_t, D64>> whole(D64 d64, V target) {
  const hn::Rebind<std::int32_t, D64> di32;
  const auto far = hn::Set(d64, double{kFarTargetPx});
  return hn::DemoteTo(di32, hn::Min(hn::Max(target, hn::Neg(far)), far));
}

template <bool kTranslation, class D64>
HWY_INLINE void project(D64 d64, const ViewProjection& view, const ProjectionSource& source,
                        int first, int end, const ProjectedRow& row) {
  const hn::Rebind<float, D64> d32;
  const hn::Rebind<std::int32_t, D64> di32;
  const auto largest = hn::Set(d32, std::numeric_limits<float>::max());
  const auto unknown = hn::Set(d32, std::numeric_limits<float>::quiet_NaN());
  const auto nowhere = hn::Set(d32, -std::numeric_limits<float>::infinity());
  const auto half = hn::Set(d64, 0.5);
  const auto infinity_disparity = hn::Set(d64, view.infinity_disparity_px);
  const auto parallax0 = hn::Set(d64, view.parallax[0]);
  const auto parallax1 = hn::Set(d64, view.parallax[1]);
  const auto parallax2 = hn::Set(d64, view.parallax[2]);
  const double* h = view.homography;
  const double y = source.line;
  const auto line = hn::Set(d64, y);
  const auto step0 = hn::Set(d64, h[0]);
  const auto step1 = hn::Set(d64, h[3]);
  const auto step2 = hn::Set(d64, h[6]);
  const auto start0 = hn::Set(d64, h[1] * y + h[2]);
  const auto start1 = hn::Set(d64, h[4] * y + h[5]);
  const auto start2 = hn::Set(d64, h[7] * y + h[8]);
  for (int i = first; i < end; i += static_cast<int>(hn::Lanes(d64))) {
    const auto read = hn::LoadU(d32, source.disparity_px + i);
    auto known = hn::Le(hn::Abs(read), largest);
    const auto d = hn::PromoteTo(d64, hn::IfThenElseZero(known, read));
    // Not Iota(d64, x): only a constant start avoids a detour through memory.
    const auto x = hn::Add(hn::Iota(d64, 0), hn::Set(d64, source.first_column + i));
    auto nearness = hn::Sub(d, infinity_disparity);
    auto column = x;
    auto row_line = line;
    if constexpr (kTranslation) {
      column = hn::Add(x, hn::Floor(hn::Add(half, hn::Mul(parallax0, d))));
      row_line = hn::Add(line, hn::Floor(hn::Add(half, hn::Mul(parallax1, d))));
    } else {
      // Mul and Add, never fused: results must not depend on the instruction set.
      const auto depth_ratio = hn::Add(hn::Add(hn::Mul(step2, x), start2), hn::Mul(parallax2, d));
      const auto is_before = hn::Gt(depth_ratio, hn::Set(d64, kMinDepthRatio));
      const auto scale = hn::Div(hn::Set(d64, 1.0), hn::IfThenElse(is_before, depth_ratio, half));
      const auto u =
          hn::Mul(hn::Add(hn::Add(hn::Mul(step0, x), start0), hn::Mul(parallax0, d)), scale);
      const auto v =
          hn::Mul(hn::Add(hn::Add(hn::Mul(step1, x), start1), hn::Mul(parallax1, d)), scale);
      nearness = hn::Mul(nearness, scale);
      column = hn::Floor(hn::Add(u, half));
      row_line = hn::Floor(hn::Add(v, half));
      // 1 where the point is in front of the camera, as floats: masks of other lane sizes do not
      // convert.
      const auto before = hn::DemoteTo(d32, hn::IfThenElseZero(is_before, hn::Set(d64, 1.0)));
      known = hn::And(known, hn::Gt(before, hn::Zero(d32)));
    }
    const auto in_range =
        hn::Le(hn::Abs(nearness), hn::Set(d64, double{std::numeric_limits<float>::max()}));
    const auto representable = hn::DemoteTo(d32, hn::IfThenElseZero(in_range, hn::Set(d64, 1.0)));
    known = hn::And(known, hn::Gt(representable, hn::Zero(d32)));
    const auto q = hn::DemoteTo(d32, hn::IfThenElseZero(in_range, nearness));
    const auto known_int = hn::RebindMask(di32, known);
    hn::StoreU(hn::IfThenElse(known, read, unknown), d32, row.disparity_px + i);
    hn::StoreU(hn::IfThenElse(known, q, nowhere), d32, row.nearness + i);
    hn::StoreU(hn::IfThenElseZero(known_int, whole(d64, column)), di32, row.column + i);
    hn::StoreU(hn::IfThenElseZero(known_int, whole(d64, row_line)), di32, row.line + i);
  }
}

template <bool kTranslation>
HWY_INLINE void project_all(const ViewProjection& given_view, const ProjectionSource& given_source,
                            const ProjectedRow& given_row) {
  const hn::ScalableTag<double> d64;
  const hn::CappedTag<double, 1> d64_one;
  // Local copies: stores cannot alias them.
  const ViewProjection view = given_view;
  const ProjectionSource source = given_source;
  const ProjectedRow row = given_row;
  const int whole_vectors = source.count - source.count % static_cast<int>(hn::Lanes(d64));
  project<kTranslation>(d64, view, source, 0, whole_vectors, row);
  project<kTranslation>(d64_one, view, source, whole_vectors, source.count, row);
}

void project_any(const ViewProjection& view, const ProjectionSource& source,
                 const ProjectedRow& row) {
  if (view.is_translation) {
    project_all<true>(view, source, row);
  } else {
    project_all<false>(view, source, row);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(project_any);

void project_row(const ViewProjection& view, const ProjectionSource& source,
                 const ProjectedRow& row) {
  HWY_DYNAMIC_DISPATCH(project_any)(view, source, row);
}

}  // namespace vantage::kernels
#endif
