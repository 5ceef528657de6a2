// Planes of a vector of pixels or blocks, the vector form of surface_plane.h. Included once per
// target by dispatched files.

#if defined(VANTAGE_KERNELS_SURFACE_PLANE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VANTAGE_KERNELS_SURFACE_PLANE_INL_H_
#undef VANTAGE_KERNELS_SURFACE_PLANE_INL_H_
#else
#define VANTAGE_KERNELS_SURFACE_PLANE_INL_H_
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "kernels/simd-inl.h"
#include "kernels/surface_fit/surface_fit.h"
#include "kernels/surface_fit/surface_plane.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using SurfaceTag = hn::ScalableTag<std::int16_t>;
using SurfaceVec = hn::VFromD<SurfaceTag>;
constexpr int kSurfaceStep = static_cast<int>(hn::MaxLanes(SurfaceTag()));
static_assert(kSurfaceStep - 1 <= kSurfaceRowSlack);
/// A vector of floats holds half as many pixels as one of 16-bit integers.
using SurfaceTagF = hn::ScalableTag<float>;
using SurfaceVecF = hn::VFromD<SurfaceTagF>;
constexpr int kSurfaceStepF = kSurfaceStep / 2;

HWY_INLINE SurfaceVecF load_as_float(const std::int16_t* values) {
  const SurfaceTagF d;
  const hn::RebindToSigned<SurfaceTagF> d_int;
  return hn::ConvertTo(d, hn::PromoteTo(d_int, hn::LoadU(hn::Half<SurfaceTag>(), values)));
}

/// To nearest integers, halves to even, of values whose integers fit 16 bits.
HWY_INLINE SurfaceVec to_samples(SurfaceVecF lower, SurfaceVecF upper) {
  const SurfaceTag d;
  // Sums with this have their integer part in the lowest bits.
  const SurfaceVecF shift = hn::Set(SurfaceTagF(), 0x1.8p23F);
  return hn::ConcatEven(d, hn::BitCast(d, hn::Add(upper, shift)),
                        hn::BitCast(d, hn::Add(lower, shift)));
}

struct SurfacePlanes {
  SurfaceVecF height, slope_u, slope_v;
};

/// First planes of part of a row.
struct SurfaceFirstRow {
  static constexpr int kSize = 512;
  HWY_ALIGN std::int16_t height[kSize];
  HWY_ALIGN std::int16_t slope_u[kSize];
  HWY_ALIGN std::int16_t slope_v[kSize];
};

struct SurfaceSumVectors {
  SurfaceVec w, wu, wv, wuu, wuv, wvv, we, weu, wev;
};

/// The sums of part of a row. In memory, because loops over sums and over equations keep the
/// processor busier than one over both.
struct SurfaceSumRow {
  static constexpr int kSize = SurfaceFirstRow::kSize;
  HWY_ALIGN std::int16_t w[kSize];
  HWY_ALIGN std::int16_t wu[kSize];
  HWY_ALIGN std::int16_t wv[kSize];
  HWY_ALIGN std::int16_t wuu[kSize];
  HWY_ALIGN std::int16_t wuv[kSize];
  HWY_ALIGN std::int16_t wvv[kSize];
  HWY_ALIGN std::int16_t we[kSize];
  HWY_ALIGN std::int16_t weu[kSize];
  HWY_ALIGN std::int16_t wev[kSize];

  HWY_INLINE void store(const SurfaceSumVectors& sums, int x) {
    const SurfaceTag d;
    hn::Store(sums.w, d, w + x);
    hn::Store(sums.wu, d, wu + x);
    hn::Store(sums.wv, d, wv + x);
    hn::Store(sums.wuu, d, wuu + x);
    hn::Store(sums.wuv, d, wuv + x);
    hn::Store(sums.wvv, d, wvv + x);
    hn::Store(sums.we, d, we + x);
    hn::Store(sums.weu, d, weu + x);
    hn::Store(sums.wev, d, wev + x);
  }
};
static_assert(SurfaceSumRow::kSize % kSurfaceStep == 0);

/// Sums over one line of samples along u.
struct SurfaceLine {
  SurfaceVec w, wu, wuu, we, weu;
};

/// A lattice of kSteps steps in memory.
template <int kSteps>
struct SurfacePlaces {
  std::ptrdiff_t along_u, along_v;  ///< from a sample to the next
  float ridge;
  int max_first;  ///< of the first plane's height and slopes
  HWY_ALIGN std::int16_t reach[kSurfaceStep];
  HWY_ALIGN std::uint16_t share[9][kSurfaceStep];

  SurfacePlaces(const SurfaceLattice& lattice, const SurfaceRow& row)
      : along_u(lattice.row(1, 0) * row.pitch + lattice.column(1, 0)),
        along_v(lattice.row(0, 1) * row.pitch + lattice.column(0, 1)),
        ridge(surface_ridge(lattice)),
        max_first(kMaxFirstSurfacePx << row.format.fraction_bits) {
    const SurfaceWeights weights = surface_weights(lattice, row.format);
    std::fill_n(reach, kSurfaceStep, static_cast<std::int16_t>(weights.reach));
    for (std::size_t n = 0; n < weights.share.size(); ++n) {
      std::fill_n(share[n], kSurfaceStep, weights.share[n]);
    }
  }
};

/// Weights of samples, and weights times the planes' heights above them.
struct SurfaceSamples {
  SurfaceVec w, we;
};

template <int kSteps>
HWY_INLINE SurfaceSamples weigh_surface_samples(const std::int16_t* samples, SurfaceVec plane,
                                                const SurfacePlaces<kSteps>& places,
                                                std::size_t steps2) {
  const SurfaceTag d;
  const hn::RebindToUnsigned<SurfaceTag> d_unsigned;
  // Saturated at most where the weight is 0. The absolute value of −32768 is right without a sign.
  const SurfaceVec e = hn::SaturatedSub(plane, hn::LoadU(d, samples));
  const auto reach = hn::BitCast(d_unsigned, hn::Load(d, places.reach));
  const auto inside = hn::SaturatedSub(reach, hn::BitCast(d_unsigned, hn::Abs(e)));
  const SurfaceVec w =
      hn::BitCast(d, hn::MulHigh(inside, hn::Load(d_unsigned, places.share[steps2])));
  return {w, hn::Mul(w, e)};
}

template <int kSteps>
HWY_INLINE SurfaceLine sum_surface_line(const std::int16_t* middle, int j, SurfaceVec plane,
                                        SurfaceVec slope_u, const SurfacePlaces<kSteps>& places) {
  const auto steps2 = [&](int i) { return static_cast<std::size_t>(i * i + j * j); };
  const SurfaceSamples own = weigh_surface_samples(middle, plane, places, steps2(0));
  const SurfaceSamples above =
      weigh_surface_samples(middle + places.along_u, hn::Add(plane, slope_u), places, steps2(1));
  const SurfaceSamples below =
      weigh_surface_samples(middle - places.along_u, hn::Sub(plane, slope_u), places, steps2(1));
  const SurfaceVec w = hn::Add(above.w, below.w);
  SurfaceLine line{hn::Add(own.w, w), hn::Sub(above.w, below.w), w,
                   hn::Add(own.we, hn::Add(above.we, below.we)), hn::Sub(above.we, below.we)};
  if constexpr (kSteps == 2) {
    const SurfaceVec slope_2u = hn::Add(slope_u, slope_u);
    const SurfaceSamples far_above = weigh_surface_samples(
        middle + 2 * places.along_u, hn::Add(plane, slope_2u), places, steps2(2));
    const SurfaceSamples far_below = weigh_surface_samples(
        middle - 2 * places.along_u, hn::Sub(plane, slope_2u), places, steps2(2));
    const SurfaceVec far_w = hn::Add(far_above.w, far_below.w);
    const SurfaceVec far_wu = hn::Sub(far_above.w, far_below.w);
    const SurfaceVec far_weu = hn::Sub(far_above.we, far_below.we);
    line.w = hn::Add(line.w, far_w);
    line.wu = hn::Add(line.wu, hn::Add(far_wu, far_wu));
    line.wuu = hn::Add(line.wuu, hn::ShiftLeft<2>(far_w));
    line.we = hn::Add(line.we, hn::Add(far_above.we, far_below.we));
    line.weu = hn::Add(line.weu, hn::Add(far_weu, far_weu));
  }
  return line;
}

/// Adds the lines j steps above and below the middle.
template <int j>
HWY_INLINE void add_surface_lines(const SurfaceLine& above, const SurfaceLine& below,
                                  SurfaceSumVectors& sums) {
  const auto times_j = [](SurfaceVec v) HWY_ATTR { return j == 1 ? v : hn::Add(v, v); };
  const SurfaceVec w = hn::Add(above.w, below.w);
  sums.w = hn::Add(sums.w, w);
  sums.wu = hn::Add(sums.wu, hn::Add(above.wu, below.wu));
  sums.wv = hn::Add(sums.wv, times_j(hn::Sub(above.w, below.w)));
  sums.wuu = hn::Add(sums.wuu, hn::Add(above.wuu, below.wuu));
  sums.wuv = hn::Add(sums.wuv, times_j(hn::Sub(above.wu, below.wu)));
  sums.wvv = hn::Add(sums.wvv, j == 1 ? w : hn::ShiftLeft<2>(w));
  sums.we = hn::Add(sums.we, hn::Add(above.we, below.we));
  sums.weu = hn::Add(sums.weu, hn::Add(above.weu, below.weu));
  sums.wev = hn::Add(sums.wev, times_j(hn::Sub(above.we, below.we)));
}

template <int kSteps>
HWY_INLINE SurfaceSumVectors sum_surface_samples(const std::int16_t* centres,
                                                 const SurfacePlaces<kSteps>& places,
                                                 SurfaceVec middle, SurfaceVec slope_u,
                                                 SurfaceVec slope_v) {
  const SurfaceVec zero = hn::Zero(SurfaceTag());
  const SurfaceLine own = sum_surface_line(centres, 0, middle, slope_u, places);
  SurfaceSumVectors sums{own.w, own.wu, zero, own.wuu, zero, zero, own.we, own.weu, zero};
  add_surface_lines<1>(
      sum_surface_line(centres + places.along_v, 1, hn::Add(middle, slope_v), slope_u, places),
      sum_surface_line(centres - places.along_v, 1, hn::Sub(middle, slope_v), slope_u, places),
      sums);
  if constexpr (kSteps == 2) {
    const SurfaceVec slope_2v = hn::Add(slope_v, slope_v);
    add_surface_lines<2>(sum_surface_line(centres + 2 * places.along_v, 2,
                                          hn::Add(middle, slope_2v), slope_u, places),
                         sum_surface_line(centres - 2 * places.along_v, 2,
                                          hn::Sub(middle, slope_2v), slope_u, places),
                         sums);
  }
  return sums;
}

/// The sums of kSurfaceStep pixels at a time; `first`: null in the first pass, whose planes are
/// level ones through the centres.
template <bool kIsFirst, int kSteps>
HWY_NOINLINE void sum_surface_row(const std::int16_t* centres, int width,
                                  const SurfacePlaces<kSteps>& places, const SurfaceFirstRow* first,
                                  SurfaceSumRow& sums) {
  const SurfaceTag d;
  const SurfaceVec zero = hn::Zero(d);
  for (int x = 0; x < width; x += kSurfaceStep) {
    const SurfaceVec own = hn::LoadU(d, centres + x);
    if constexpr (kIsFirst) {
      sums.store(sum_surface_samples(centres + x, places, own, zero, zero), x);
    } else {
      sums.store(
          sum_surface_samples(centres + x, places, hn::Add(own, hn::Load(d, first->height + x)),
                              hn::Load(d, first->slope_u + x), hn::Load(d, first->slope_v + x)),
          x);
    }
  }
}

/// Corrections of the planes of kSurfaceStepF pixels, from column x of `sums` on.
HWY_INLINE SurfacePlanes surface_corrections(const SurfaceSumRow& sums, int x, float ridge) {
  const SurfaceTagF d;
  const SurfaceVecF w = hn::Max(load_as_float(sums.w + x), hn::Set(d, 1.0F));
  const SurfaceVecF wu = load_as_float(sums.wu + x);
  const SurfaceVecF wv = load_as_float(sums.wv + x);
  const SurfaceVecF wuu = load_as_float(sums.wuu + x);
  const SurfaceVecF wuv = load_as_float(sums.wuv + x);
  const SurfaceVecF wvv = load_as_float(sums.wvv + x);
  const SurfaceVecF we = load_as_float(sums.we + x);
  const SurfaceVecF weu = load_as_float(sums.weu + x);
  const SurfaceVecF wev = load_as_float(sums.wev + x);
  const SurfaceVecF ridge_ww = hn::Mul(hn::Mul(w, w), hn::Set(d, ridge));
  const SurfaceVecF uu = hn::Add(hn::Sub(hn::Mul(wuu, w), hn::Mul(wu, wu)), ridge_ww);
  const SurfaceVecF vv = hn::Add(hn::Sub(hn::Mul(wvv, w), hn::Mul(wv, wv)), ridge_ww);
  const SurfaceVecF uv = hn::Sub(hn::Mul(wuv, w), hn::Mul(wu, wv));
  const SurfaceVecF eu = hn::Sub(hn::Mul(weu, w), hn::Mul(we, wu));
  const SurfaceVecF ev = hn::Sub(hn::Mul(wev, w), hn::Mul(we, wv));
  const SurfaceVecF determinant = hn::Sub(hn::Mul(uu, vv), hn::Mul(uv, uv));
  const SurfaceVecF inverse = hn::Div(hn::Set(d, 1.0F), hn::Mul(determinant, w));
  const SurfaceVecF per_determinant = hn::Mul(inverse, w);
  const SurfaceVecF per_w = hn::Mul(inverse, determinant);
  const SurfaceVecF slope_u = hn::Mul(hn::Sub(hn::Mul(eu, vv), hn::Mul(ev, uv)), per_determinant);
  const SurfaceVecF slope_v = hn::Mul(hn::Sub(hn::Mul(ev, uu), hn::Mul(eu, uv)), per_determinant);
  const SurfaceVecF height =
      hn::Mul(hn::Sub(hn::Sub(we, hn::Mul(slope_u, wu)), hn::Mul(slope_v, wv)), per_w);
  return {height, slope_u, slope_v};
}

/// The first pass over up to SurfaceFirstRow::kSize pixels or blocks.
template <int kSteps>
HWY_INLINE void fit_first_surface_planes(const std::int16_t* centres, int width,
                                         const SurfacePlaces<kSteps>& places, SurfaceSumRow& sums,
                                         SurfaceFirstRow& planes) {
  const SurfaceTag d;
  const SurfaceVec limit = hn::Set(d, static_cast<std::int16_t>(places.max_first));
  sum_surface_row<true>(centres, width, places, nullptr, sums);
  for (int x = 0; x < width; x += kSurfaceStep) {
    const SurfacePlanes lower = surface_corrections(sums, x, places.ridge);
    const SurfacePlanes upper = surface_corrections(sums, x + kSurfaceStepF, places.ridge);
    const auto store = [&](SurfaceVecF lower_half, SurfaceVecF upper_half,
                           std::int16_t* values) HWY_ATTR {
      const SurfaceVec down = to_samples(lower_half, upper_half);
      hn::Store(hn::Max(hn::Min(hn::Neg(down), limit), hn::Neg(limit)), d, values + x);
    };
    store(lower.height, upper.height, planes.height);
    store(lower.slope_u, upper.slope_u, planes.slope_u);
    store(lower.slope_v, upper.slope_v, planes.slope_v);
  }
}

/// Both passes over part of a row of pixels or blocks.
template <int kSteps>
class SurfaceRowFit {
 public:
  static constexpr int kSize = SurfaceFirstRow::kSize;
  SurfaceRowFit(const SurfaceLattice& lattice, const SurfaceRow& row) : places_(lattice, row) {}

  /// width ≤ kSize.
  HWY_INLINE void fit(const std::int16_t* centres, int width) {
    fit_first_surface_planes(centres, width, places_, sums_, first_);
    sum_surface_row<false>(centres, width, places_, &first_, sums_);
  }
  /// The planes of kSurfaceStepF pixels, from column x on.
  [[nodiscard]] HWY_INLINE SurfacePlanes planes(int x) const {
    const SurfacePlanes above = surface_corrections(sums_, x, places_.ridge);
    return {hn::Sub(load_as_float(first_.height + x), above.height),
            hn::Sub(load_as_float(first_.slope_u + x), above.slope_u),
            hn::Sub(load_as_float(first_.slope_v + x), above.slope_v)};
  }

 private:
  SurfacePlaces<kSteps> places_;
  SurfaceFirstRow first_;
  SurfaceSumRow sums_;
};

/// Makes disparities of what is in steps of a format, and clamps them.
struct SurfaceDisparities {
  explicit SurfaceDisparities(const SurfaceRow& row)
      : middle_px(hn::Set(SurfaceTagF(), row.format.middle_px)),
        px_per_unit(hn::Set(SurfaceTagF(), 1 / row.format.units_per_px())),
        min_px(hn::Set(SurfaceTagF(), row.min_px)),
        max_px(hn::Set(SurfaceTagF(), row.max_px)) {}
  [[nodiscard]] HWY_INLINE SurfaceVecF px(SurfaceVecF units) const {
    return hn::Add(middle_px, hn::Mul(units, px_per_unit));
  }
  [[nodiscard]] HWY_INLINE SurfaceVecF clamp(SurfaceVecF px) const {
    return hn::Min(hn::Max(px, min_px), max_px);
  }
  SurfaceVecF middle_px, px_per_unit, min_px, max_px;
};

/// Disparities as they are stored.
struct SurfaceStorage {
  explicit SurfaceStorage(const SurfaceFormat& format)
      : middle_px(hn::Set(SurfaceTagF(), format.middle_px)),
        units_per_px(hn::Set(SurfaceTagF(), format.units_per_px())),
        limit(hn::Set(SurfaceTagF(), static_cast<float>(max_surface_sample(format)))) {}
  [[nodiscard]] HWY_INLINE SurfaceVec stored(SurfaceVecF lower_px, SurfaceVecF upper_px) const {
    const auto units = [&](SurfaceVecF px) HWY_ATTR {
      const SurfaceVecF unlimited = hn::Mul(hn::Sub(px, middle_px), units_per_px);
      return hn::Max(hn::Min(unlimited, limit), hn::Neg(limit));
    };
    return to_samples(units(lower_px), units(upper_px));
  }
  SurfaceVecF middle_px, units_per_px, limit;
};

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard of each target
