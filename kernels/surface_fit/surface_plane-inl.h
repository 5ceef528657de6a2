// Planes of a vector of pixels or blocks, the vector form of surface_plane.h. Included once per
// target by dispatched files.

#if defined(VANTAGE_KERNELS_SURFACE_PLANE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VANTAGE_KERNELS_SURFACE_PLANE_INL_H_
#undef VANTAGE_KERNELS_SURFACE_PLANE_INL_H_
#else
#define VANTAGE_KERNELS_SURFACE_PLANE_INL_H_
#endif

#include <hwy/highway.h>

#include <array>
#include <cstddef>

#include "kernels/surface_fit/surface_fit.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using SurfaceTag = hwy::HWY_NAMESPACE::ScalableTag<float>;
using SurfaceVec = hwy::HWY_NAMESPACE::VFromD<SurfaceTag>;
constexpr int kSurfaceStep = static_cast<int>(hwy::HWY_NAMESPACE::MaxLanes(SurfaceTag()));
static_assert(kSurfaceStep - 1 <= kSurfaceRowSlack);

struct SurfacePlanes {
  SurfaceVec height, slope_u, slope_v;
};

struct SurfaceSumVectors {
  SurfaceVec w, wu, wv, wuu, wuv, wvv, we, weu, wev;
};

// Weights of samples, and weights times their distances from the planes.
struct SurfaceSamples {
  SurfaceVec w, we;
};

HWY_INLINE SurfaceSamples weigh_surface_samples(const float* disparity_px, SurfaceVec plane_px,
                                                float falloff) {
  namespace hn = hwy::HWY_NAMESPACE;
  const SurfaceTag d;
  constexpr float kPerReach = 1 / (kSurfaceReachPx * kSurfaceReachPx);
  const SurfaceVec e = hn::Sub(hn::LoadU(d, disparity_px), plane_px);
  const SurfaceVec share =
      hn::Sub(hn::Set(d, falloff), hn::Mul(hn::Mul(e, e), hn::Set(d, falloff * kPerReach)));
  const SurfaceVec w = hn::Max(share, hn::Zero(d));
  return {w, hn::Mul(w, e)};
}

// A lattice of kSteps steps in memory.
template <int kSteps>
struct SurfacePlaces {
  // Offset of sample (i, j) from the centre, and its weight on the plane: [j + kSteps][i + kSteps].
  std::ptrdiff_t offset[2 * kSteps + 1][2 * kSteps + 1];
  float falloff[2 * kSteps + 1][2 * kSteps + 1];

  SurfacePlaces(const SurfaceLattice& lattice, std::ptrdiff_t pitch) {
    for (int j = -kSteps; j <= kSteps; ++j) {
      for (int i = -kSteps; i <= kSteps; ++i) {
        offset[j + kSteps][i + kSteps] = lattice.row(i, j) * pitch + lattice.column(i, j);
        falloff[j + kSteps][i + kSteps] = lattice.falloff_at(i, j);
      }
    }
  }
};

// kIsLevel: planes are level ones through the centres.
template <bool kIsLevel, int kSteps>
HWY_INLINE SurfaceSumVectors sum_surface_samples(const float* centres,
                                                 const SurfacePlaces<kSteps>& places,
                                                 const SurfacePlanes& planes) {
  namespace hn = hwy::HWY_NAMESPACE;
  const SurfaceTag d;
  constexpr auto kStepsF = static_cast<float>(kSteps);
  const SurfaceVec zero = hn::Zero(d);
  const SurfaceVec own = hn::LoadU(d, centres);
  SurfaceSumVectors sums{zero, zero, zero, zero, zero, zero, zero, zero, zero};
  HWY_UNROLL(2 * kMaxSurfaceSteps + 1)
  for (int j = -kSteps; j <= kSteps; ++j) {
    const std::ptrdiff_t* place = places.offset[j + kSteps] + kSteps;
    const float* falloff = places.falloff[j + kSteps] + kSteps;
    const SurfaceVec v = hn::Set(d, static_cast<float>(j) / kStepsF);
    const SurfaceVec middle_px =
        kIsLevel ? own : hn::Add(own, hn::Add(planes.height, hn::Mul(planes.slope_v, v)));
    const SurfaceSamples middle = weigh_surface_samples(centres + place[0], middle_px, falloff[0]);
    SurfaceVec line_w = middle.w;
    SurfaceVec line_wu = zero;
    SurfaceVec line_wuu = zero;
    SurfaceVec line_we = middle.we;
    SurfaceVec line_weu = zero;
    HWY_UNROLL(kMaxSurfaceSteps)
    for (int i = 1; i <= kSteps; ++i) {
      const float step = static_cast<float>(i) / kStepsF;
      const SurfaceVec u = hn::Set(d, step);
      const SurfaceVec rise_px = kIsLevel ? zero : hn::Mul(planes.slope_u, u);
      const SurfaceSamples above = weigh_surface_samples(
          centres + place[i], kIsLevel ? own : hn::Add(middle_px, rise_px), falloff[i]);
      const SurfaceSamples below = weigh_surface_samples(
          centres + place[-i], kIsLevel ? own : hn::Sub(middle_px, rise_px), falloff[i]);
      const SurfaceVec w = hn::Add(above.w, below.w);
      line_w = hn::Add(line_w, w);
      line_wu = hn::Add(line_wu, hn::Mul(hn::Sub(above.w, below.w), u));
      line_wuu = hn::Add(line_wuu, hn::Mul(w, hn::Set(d, step * step)));
      line_we = hn::Add(line_we, hn::Add(above.we, below.we));
      line_weu = hn::Add(line_weu, hn::Mul(hn::Sub(above.we, below.we), u));
    }
    const SurfaceVec wv = hn::Mul(line_w, v);
    sums.w = hn::Add(sums.w, line_w);
    sums.wu = hn::Add(sums.wu, line_wu);
    sums.wv = hn::Add(sums.wv, wv);
    sums.wuu = hn::Add(sums.wuu, line_wuu);
    sums.wuv = hn::Add(sums.wuv, hn::Mul(line_wu, v));
    sums.wvv = hn::Add(sums.wvv, hn::Mul(wv, v));
    sums.we = hn::Add(sums.we, line_we);
    sums.weu = hn::Add(sums.weu, line_weu);
    sums.wev = hn::Add(sums.wev, hn::Mul(line_we, v));
  }
  return sums;
}

HWY_INLINE void improve_surface_planes(const SurfaceSumVectors& sums, SurfacePlanes& planes) {
  namespace hn = hwy::HWY_NAMESPACE;
  const SurfaceTag d;
  const SurfaceVec w = hn::Add(sums.w, hn::Set(d, kMinSurfaceWeight));
  const SurfaceVec n = hn::Div(hn::Set(d, 1.0F), w);
  const SurfaceVec u = hn::Mul(sums.wu, n);
  const SurfaceVec v = hn::Mul(sums.wv, n);
  const SurfaceVec ridge = hn::Mul(w, hn::Set(d, kSlopeRidge));
  const SurfaceVec uu = hn::Add(hn::Sub(sums.wuu, hn::Mul(sums.wu, u)), ridge);
  const SurfaceVec vv = hn::Add(hn::Sub(sums.wvv, hn::Mul(sums.wv, v)), ridge);
  const SurfaceVec uv = hn::Sub(sums.wuv, hn::Mul(sums.wu, v));
  const SurfaceVec eu = hn::Sub(sums.weu, hn::Mul(sums.we, u));
  const SurfaceVec ev = hn::Sub(sums.wev, hn::Mul(sums.we, v));
  const SurfaceVec determinant = hn::Sub(hn::Mul(uu, vv), hn::Mul(uv, uv));
  const SurfaceVec slope_u = hn::Div(hn::Sub(hn::Mul(eu, vv), hn::Mul(ev, uv)), determinant);
  const SurfaceVec slope_v = hn::Div(hn::Sub(hn::Mul(ev, uu), hn::Mul(eu, uv)), determinant);
  const SurfaceVec height =
      hn::Sub(hn::Sub(hn::Mul(sums.we, n), hn::Mul(slope_u, u)), hn::Mul(slope_v, v));
  planes.height = hn::Add(planes.height, height);
  planes.slope_u = hn::Add(planes.slope_u, slope_u);
  planes.slope_v = hn::Add(planes.slope_v, slope_v);
}

template <int kSteps>
HWY_INLINE SurfacePlanes fit_surface_planes(const float* centres,
                                            const SurfacePlaces<kSteps>& places) {
  const SurfaceVec zero = hwy::HWY_NAMESPACE::Zero(SurfaceTag());
  SurfacePlanes planes{zero, zero, zero};
  improve_surface_planes(sum_surface_samples<true>(centres, places, planes), planes);
  for (int pass = 1; pass < kSurfacePasses; ++pass) {
    improve_surface_planes(sum_surface_samples<false>(centres, places, planes), planes);
  }
  return planes;
}

// Range that fitted values are clamped to.
struct SurfaceLimits {
  explicit SurfaceLimits(const SurfaceRow& row)
      : min(hwy::HWY_NAMESPACE::Set(SurfaceTag(), row.min_px)),
        max(hwy::HWY_NAMESPACE::Set(SurfaceTag(), row.max_px)) {}
  [[nodiscard]] HWY_INLINE SurfaceVec clamp(SurfaceVec px) const {
    return hwy::HWY_NAMESPACE::Min(hwy::HWY_NAMESPACE::Max(px, min), max);
  }
  SurfaceVec min;
  SurfaceVec max;
};

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard of each target
