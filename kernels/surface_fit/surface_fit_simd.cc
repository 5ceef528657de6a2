#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/surface_fit/surface_fit_simd.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, so that it is compiled once per target.
#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>

#include "kernels/surface_fit/surface_fit.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using TagF = hn::ScalableTag<float>;
using Vec = hn::VFromD<TagF>;
constexpr int kStep = static_cast<int>(hn::MaxLanes(TagF()));
static_assert(kStep - 1 <= kSurfaceRowSlack);

// Planes of one vector of pixels; same steps as surface_fit_ref.cc.
struct Planes {
  Vec height, slope_u, slope_v;
};

struct Sums {
  Vec w, wu, wv, wuu, wuv, wvv, we, weu, wev;
};

// Weights of samples, and weights times their distances from the planes.
struct WeighedSamples {
  Vec w, we;
};

HWY_INLINE WeighedSamples weigh(const float* disparity_px, Vec plane_px) {
  const TagF d;
  const Vec per_reach = hn::Set(d, 1 / (kSurfaceReachPx * kSurfaceReachPx));
  const Vec e = hn::Sub(hn::LoadU(d, disparity_px), plane_px);
  const Vec share = hn::Sub(hn::Set(d, 1.0F), hn::Mul(hn::Mul(e, e), per_reach));
  const Vec w = hn::Max(share, hn::Zero(d));
  return {w, hn::Mul(w, e)};
}

// Offsets in memory of the samples of any pixel.
template <int kSteps>
struct Places {
  std::ptrdiff_t of[2 * kSteps + 1][2 * kSteps + 1];

  explicit Places(const SurfaceRow& row) {
    const SurfaceLattice lattice = surface_lattice(row.radius_px);
    for (int j = -kSteps; j <= kSteps; ++j) {
      for (int i = -kSteps; i <= kSteps; ++i) {
        of[j + kSteps][i + kSteps] = lattice.row(i, j) * row.pitch + lattice.column(i, j);
      }
    }
  }
};

template <int kSteps>
HWY_INLINE Sums sum_samples(const float* disparity_px, const Places<kSteps>& places,
                            const Planes& planes) {
  const TagF d;
  constexpr auto kStepsF = static_cast<float>(kSteps);
  const Vec zero = hn::Zero(d);
  const Vec own = hn::LoadU(d, disparity_px);
  Sums sums{zero, zero, zero, zero, zero, zero, zero, zero, zero};
  for (int j = -kSteps; j <= kSteps; ++j) {
    const std::ptrdiff_t* place = places.of[j + kSteps] + kSteps;
    const Vec v = hn::Set(d, static_cast<float>(j) / kStepsF);
    const Vec middle_px = hn::Add(own, hn::Add(planes.height, hn::Mul(planes.slope_v, v)));
    const WeighedSamples middle = weigh(disparity_px + place[0], middle_px);
    Vec line_w = middle.w;
    Vec line_wu = zero;
    Vec line_wuu = zero;
    Vec line_we = middle.we;
    Vec line_weu = zero;
    HWY_UNROLL(kMaxSurfaceSteps)
    for (int i = 1; i <= kSteps; ++i) {
      const float step = static_cast<float>(i) / kStepsF;
      const Vec u = hn::Set(d, step);
      const Vec rise_px = hn::Mul(planes.slope_u, u);
      const WeighedSamples above = weigh(disparity_px + place[i], hn::Add(middle_px, rise_px));
      const WeighedSamples below = weigh(disparity_px + place[-i], hn::Sub(middle_px, rise_px));
      const Vec w = hn::Add(above.w, below.w);
      line_w = hn::Add(line_w, w);
      line_wu = hn::Add(line_wu, hn::Mul(hn::Sub(above.w, below.w), u));
      line_wuu = hn::Add(line_wuu, hn::Mul(w, hn::Set(d, step * step)));
      line_we = hn::Add(line_we, hn::Add(above.we, below.we));
      line_weu = hn::Add(line_weu, hn::Mul(hn::Sub(above.we, below.we), u));
    }
    const Vec wv = hn::Mul(line_w, v);
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

HWY_INLINE void improve(const Sums& sums, Planes& planes) {
  const TagF d;
  const Vec w = hn::Add(sums.w, hn::Set(d, kMinSurfaceWeight));
  const Vec n = hn::Div(hn::Set(d, 1.0F), w);
  const Vec u = hn::Mul(sums.wu, n);
  const Vec v = hn::Mul(sums.wv, n);
  const Vec ridge = hn::Mul(w, hn::Set(d, kSlopeRidge));
  const Vec uu = hn::Add(hn::Sub(sums.wuu, hn::Mul(sums.wu, u)), ridge);
  const Vec vv = hn::Add(hn::Sub(sums.wvv, hn::Mul(sums.wv, v)), ridge);
  const Vec uv = hn::Sub(sums.wuv, hn::Mul(sums.wu, v));
  const Vec eu = hn::Sub(sums.weu, hn::Mul(sums.we, u));
  const Vec ev = hn::Sub(sums.wev, hn::Mul(sums.we, v));
  const Vec determinant = hn::Sub(hn::Mul(uu, vv), hn::Mul(uv, uv));
  const Vec slope_u = hn::Div(hn::Sub(hn::Mul(eu, vv), hn::Mul(ev, uv)), determinant);
  const Vec slope_v = hn::Div(hn::Sub(hn::Mul(ev, uu), hn::Mul(eu, uv)), determinant);
  const Vec height =
      hn::Sub(hn::Sub(hn::Mul(sums.we, n), hn::Mul(slope_u, u)), hn::Mul(slope_v, v));
  planes.height = hn::Add(planes.height, height);
  planes.slope_u = hn::Add(planes.slope_u, slope_u);
  planes.slope_v = hn::Add(planes.slope_v, slope_v);
}

// Range that fitted values are clamped to.
struct Limits {
  explicit Limits(const SurfaceRow& row)
      : min(hn::Set(TagF(), row.min_px)), max(hn::Set(TagF(), row.max_px)) {}
  Vec min;
  Vec max;
};

// `before`: values of pixels that are not changed.
template <int kSteps>
HWY_INLINE Vec fitted(const float* disparity_px, const Places<kSteps>& places, const Limits& limits,
                      Vec before) {
  const TagF d;
  Planes planes{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  for (int pass = 0; pass < kSurfacePasses; ++pass) {
    improve(sum_samples(disparity_px, places, planes), planes);
  }
  const Vec own = hn::LoadU(d, disparity_px);
  const auto is_near = hn::Lt(hn::Abs(planes.height), hn::Set(d, kSurfaceReachPx));
  const auto is_matched = hn::Lt(own, hn::Set(d, kNoSurfacePx));
  const Vec within = hn::Min(hn::Max(hn::Add(own, planes.height), limits.min), limits.max);
  return hn::IfThenElse(hn::And(is_near, is_matched), within, before);
}

template <int kSteps>
HWY_INLINE void fit_row(const SurfaceRow& row, float* fitted_px) {
  const TagF d;
  const Places<kSteps> places(row);
  const Limits limits(row);
  int x = 0;
  for (; x + kStep <= row.width; x += kStep) {
    const Vec before = hn::LoadU(d, fitted_px + x);
    hn::StoreU(fitted(row.disparity_px + x, places, limits, before), d, fitted_px + x);
  }
  if (x < row.width) {
    HWY_ALIGN float last[kStep] = {};
    std::copy_n(fitted_px + x, row.width - x, last);
    const Vec before = hn::Load(d, last);
    hn::Store(fitted(row.disparity_px + x, places, limits, before), d, last);
    std::copy_n(last, row.width - x, fitted_px + x);
  }
}

void fit_surface_simd(const SurfaceRow& row, float* fitted_px) {
  if (surface_lattice(row.radius_px).steps == kMaxSurfaceSteps) {
    fit_row<kMaxSurfaceSteps>(row, fitted_px);
  } else {
    fit_row<1>(row, fitted_px);
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
