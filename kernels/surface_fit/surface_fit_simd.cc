#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/surface_fit/surface_fit_simd.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, so that it is compiled once per target.
#include <hwy/highway.h>

#include <algorithm>

#include "kernels/surface_fit/surface_fit.h"
#include "kernels/surface_fit/surface_plane-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// `before`: values of pixels that are not changed.
template <int kSteps>
HWY_INLINE SurfaceVec fitted(const float* disparity_px, const SurfacePlaces<kSteps>& places,
                             const SurfaceLimits& limits, SurfaceVec before) {
  const SurfaceTag d;
  const SurfaceVec height = fit_surface_planes(disparity_px, places).height;
  const SurfaceVec own = hn::LoadU(d, disparity_px);
  const auto is_near = hn::Lt(hn::Abs(height), hn::Set(d, kSurfaceReachPx));
  const auto is_matched = hn::Lt(own, hn::Set(d, kNoSurfacePx));
  return hn::IfThenElse(hn::And(is_near, is_matched), limits.clamp(hn::Add(own, height)), before);
}

template <int kSteps>
HWY_INLINE void fit_row(const SurfaceRow& row, const SurfaceLattice& lattice, float* fitted_px) {
  const SurfaceTag d;
  const SurfacePlaces<kSteps> places(lattice, row.pitch);
  const SurfaceLimits limits(row);
  int x = 0;
  for (; x + kSurfaceStep <= row.width; x += kSurfaceStep) {
    const SurfaceVec before = hn::LoadU(d, fitted_px + x);
    hn::StoreU(fitted(row.disparity_px + x, places, limits, before), d, fitted_px + x);
  }
  if (x < row.width) {
    HWY_ALIGN float last[kSurfaceStep] = {};
    std::copy_n(fitted_px + x, row.width - x, last);
    const SurfaceVec before = hn::Load(d, last);
    hn::Store(fitted(row.disparity_px + x, places, limits, before), d, last);
    std::copy_n(last, row.width - x, fitted_px + x);
  }
}

void fit_surface_simd(const SurfaceRow& row, float* fitted_px) {
  const SurfaceLattice lattice = surface_lattice(row.radius_px);
  if (lattice.steps == kMaxSurfaceSteps) {
    fit_row<kMaxSurfaceSteps>(row, lattice, fitted_px);
  } else {
    fit_row<1>(row, lattice, fitted_px);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(fit_surface_simd);

void fit_surface_row(const SurfaceRow& row, float* fitted_px) {
  HWY_DYNAMIC_DISPATCH(fit_surface_simd)(row, fitted_px);
}

}  // namespace vantage::kernels
#endif
