#include "kernels/simd-inl.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "kernels/surface_fit/surface_fit.h"
#include "kernels/surface_fit/surface_plane-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

void sample_row_simd(const float* disparity_px, const std::uint8_t* unmatched, int width,
                     const SurfaceFormat& format, std::int16_t* samples) {
  const SurfaceTagF d;
  const SurfaceTag d_sample;
  const hn::Rebind<std::uint8_t, SurfaceTag> d_byte;
  const SurfaceStorage storage(format);
  const auto none = hn::Set(d_sample, kNoSurface);
  const auto make = [&](const float* px, const std::uint8_t* mask, std::int16_t* stored) HWY_ATTR {
    const auto is_matched =
        hn::Eq(hn::PromoteTo(d_sample, hn::LoadU(d_byte, mask)), hn::Zero(d_sample));
    const SurfaceVec matched = storage.stored(hn::LoadU(d, px), hn::LoadU(d, px + kSurfaceStepF));
    hn::StoreU(hn::IfThenElse(is_matched, matched, none), d_sample, stored);
  };
  int x = 0;
  for (; x + kSurfaceStep <= width; x += kSurfaceStep) {
    make(disparity_px + x, unmatched + x, samples + x);
  }
  if (x < width) {
    HWY_ALIGN float px[kSurfaceStep] = {};
    HWY_ALIGN std::uint8_t mask[kSurfaceStep] = {};
    HWY_ALIGN std::int16_t stored[kSurfaceStep];
    std::copy_n(disparity_px + x, width - x, px);
    std::copy_n(unmatched + x, width - x, mask);
    make(px, mask, stored);
    std::copy_n(stored, width - x, samples + x);
  }
}

// Moves kSurfaceStepF pixels to their planes.
HWY_INLINE void take_planes(const std::int16_t* samples, SurfaceVecF height,
                            const SurfaceDisparities& disparities, SurfaceVecF max_move,
                            float* fitted_px) {
  const SurfaceTagF d;
  const SurfaceVecF own = load_as_float(samples);
  const auto is_near = hn::Lt(hn::Abs(height), max_move);
  const auto is_matched = hn::Gt(own, hn::Set(d, static_cast<float>(kNoSurface)));
  const SurfaceVecF fitted = disparities.clamp(disparities.px(hn::Add(own, height)));
  hn::StoreU(hn::IfThenElse(hn::And(is_near, is_matched), fitted, hn::LoadU(d, fitted_px)), d,
             fitted_px);
}

template <int kSteps>
HWY_INLINE void fit_row(const SurfaceRow& row, const SurfaceLattice& lattice, float* fitted_px) {
  const SurfaceDisparities disparities(row);
  const SurfaceVecF max_move =
      hn::Set(SurfaceTagF(), kMaxSurfaceMovePx * row.format.units_per_px());
  SurfaceRowFit<kSteps> fit(lattice, row);
  for (int part = 0; part < row.width; part += fit.kSize) {
    const std::int16_t* samples = row.samples + part;
    float* const part_px = fitted_px + part;
    const int width = std::min(fit.kSize, row.width - part);
    fit.fit(samples, width);
    int x = 0;
    for (; x + kSurfaceStepF <= width; x += kSurfaceStepF) {
      take_planes(samples + x, fit.planes(x).height, disparities, max_move, part_px + x);
    }
    if (x < width) {
      HWY_ALIGN float last[kSurfaceStepF] = {};
      std::copy_n(part_px + x, width - x, last);
      take_planes(samples + x, fit.planes(x).height, disparities, max_move, last);
      std::copy_n(last, width - x, part_px + x);
    }
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
HWY_EXPORT(sample_row_simd);
HWY_EXPORT(fit_surface_simd);

void surface_sample_row(const float* disparity_px, const std::uint8_t* unmatched, int width,
                        const SurfaceFormat& format, std::int16_t* samples) {
  HWY_DYNAMIC_DISPATCH(sample_row_simd)(disparity_px, unmatched, width, format, samples);
}

void fit_surface_row(const SurfaceRow& row, float* fitted_px) {
  HWY_DYNAMIC_DISPATCH(fit_surface_simd)(row, fitted_px);
}

SurfaceFormat surface_format(int min_px, int max_px) {
  constexpr int kMinFractionBits = 3;  // with less, weights have no steps left
  SurfaceFormat format;
  format.middle_px = 0.5F * static_cast<float>(min_px + max_px);
  const auto fits = [&] {
    const float reach_px = 0.5F * static_cast<float>(max_px - min_px) + kSurfaceRangeMarginPx;
    return reach_px * format.units_per_px() <= static_cast<float>(max_surface_sample(format));
  };
  while (format.fraction_bits > kMinFractionBits && !fits()) {
    --format.fraction_bits;
  }
  return format;
}

SurfaceLattice surface_lattice(int radius_px) {
  if (radius_px < kMaxSurfaceSteps) {
    return {};
  }
  // Arms of two steps reach 2 · (step_x + step_y) columns and rows. At a ratio near 3 : 2 they are
  // about equally far from the rows and from the diagonals.
  const int both = radius_px / kMaxSurfaceSteps;
  const int step_y = radius_px / 5;
  return {.steps = kMaxSurfaceSteps, .step_x = both - step_y, .step_y = step_y};
}

SurfaceWeights surface_weights(const SurfaceLattice& lattice, const SurfaceFormat& format) {
  SurfaceWeights weights;
  weights.reach = static_cast<int>(kSurfaceReachPx * format.units_per_px());
  const float unit = std::min(
      static_cast<float>(lattice.unit_weight << 16) / static_cast<float>(weights.reach), 65535.0F);
  std::transform(
      lattice.falloff.begin(), lattice.falloff.end(), weights.share.begin(),
      [&](float falloff) { return static_cast<std::uint16_t>(std::lround(falloff * unit)); });
  return weights;
}

}  // namespace vantage::kernels
#endif
