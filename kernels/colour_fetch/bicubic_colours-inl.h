// Bicubic interpolation along a row, several positions at once. Included once per target by
// dispatched files.

#if defined(VANTAGE_KERNELS_BICUBIC_COLOURS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VANTAGE_KERNELS_BICUBIC_COLOURS_INL_H_
#undef VANTAGE_KERNELS_BICUBIC_COLOURS_INL_H_
#else
#define VANTAGE_KERNELS_BICUBIC_COLOURS_INL_H_
#endif

#include <cstdint>

#include "kernels/colour_fetch/colour_fetch.h"
#include "kernels/keys_weights-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// Positions processed at a time.
using Values = hn::CappedTag<float, 16>;
using Columns = hn::RebindToSigned<Values>;
using Vec = hn::VFromD<Values>;
using ColumnVec = hn::VFromD<Columns>;
constexpr int kAtOnce = static_cast<int>(hn::MaxLanes(Values()));

// Source columns n + s·d, limited to [−1, width − ½].
struct Places {
  ColumnVec whole;  // floor
  Vec fraction;
};

// The places of half of the positions, computed in double as in every other way to a place.
using HalfValues = hn::Half<Values>;
struct HalfPlaces {
  hn::VFromD<hn::RebindToSigned<HalfValues>> whole;
  hn::VFromD<HalfValues> fraction;
};
HWY_INLINE HalfPlaces find_half_places(const BicubicFetchRow& row, int n,
                                       hn::VFromD<HalfValues> disparity_px) {
  const HalfValues d;
  const hn::RebindToSigned<HalfValues> di;
  const hn::Rebind<double, HalfValues> d64;
  // Not Iota(d64, n): only a constant start avoids a detour through memory.
  const auto position = hn::Add(hn::Iota(d64, 0), hn::Set(d64, n));
  const auto exact =
      hn::Add(position, hn::Mul(hn::Set(d64, row.camera_offset), hn::PromoteTo(d64, disparity_px)));
  const auto column = hn::Min(hn::Max(exact, hn::Set(d64, -1.0)), hn::Set(d64, row.width - 0.5));
  const auto whole = hn::Floor(column);
  return {hn::DemoteTo(di, whole), hn::DemoteTo(d, hn::Sub(column, whole))};
}

// `disparity_px`: 0 at holes.
HWY_INLINE Places find_places(const BicubicFetchRow& row, int n, Vec disparity_px) {
  const Values d;
  const Columns di;
  const HalfValues half;
  const HalfPlaces low = find_half_places(row, n, hn::LowerHalf(half, disparity_px));
  const HalfPlaces high = find_half_places(row, n + kAtOnce / 2, hn::UpperHalf(half, disparity_px));
  return {hn::Combine(di, high.whole, low.whole), hn::Combine(d, high.fraction, low.fraction)};
}

// Weighted taps, clamped to the range of values. kInRange: all taps lie within the pixel type's
// range.
template <bool kInRange>
HWY_INLINE Vec interpolate(const Vec (&value)[4], const KeysWeightVectors<Values>& weights,
                           Vec largest_value) {
  const Values d;
  const auto& weight = weights.at;
  // Mul and Add, never MulAdd: results must not depend on the instruction set.
  const auto sum = hn::Add(hn::Add(hn::Mul(weight[0], value[0]), hn::Mul(weight[1], value[1])),
                           hn::Add(hn::Mul(weight[2], value[2]), hn::Mul(weight[3], value[3])));
  if constexpr (kInRange) {
    return hn::Min(hn::Max(sum, hn::Zero(d)), largest_value);
  }
  const auto smallest =
      hn::Min(hn::Zero(d), hn::Min(hn::Min(value[0], value[1]), hn::Min(value[2], value[3])));
  const auto largest =
      hn::Max(largest_value, hn::Max(hn::Max(value[0], value[1]), hn::Max(value[2], value[3])));
  return hn::Min(hn::Max(sum, smallest), largest);
}

// Taps at adjacent columns, one stretch of a row each.
struct AdjacentTaps {
  int first;  // column of tap 0 of the first position

  HWY_INLINE Vec load(const float* row, int tap) const {
    return hn::LoadU(Values(), row + first + tap);
  }
};

// A vector of columns per tap.
struct TapColumns {
  ColumnVec at[4];
};

HWY_INLINE TapColumns columns_at(ColumnVec whole) {
  const Columns di;
  const auto one = hn::Set(di, 1);
  const auto next = hn::Add(whole, one);
  return {{hn::Sub(whole, one), whole, next, hn::Add(next, one)}};
}

// Taps within two vectors of a row, from column `first` on; meaningless where they are not.
struct NearTaps {
  int first;
  ColumnVec element[4];

  HWY_INLINE NearTaps(int first_column, const TapColumns& columns) : first(first_column) {
    for (int k = 0; k < 4; ++k) {
      element[k] = hn::Sub(columns.at[k], hn::Set(Columns(), first));
    }
  }

  HWY_INLINE Vec load(const float* row, int tap) const {
    const Values d;
    const auto low = hn::LoadU(d, row + first);
    const auto high = hn::LoadU(d, row + first + kAtOnce);
#if HWY_TARGET <= HWY_AVX3
    return Vec{_mm512_permutex2var_ps(low.raw, element[tap].raw, high.raw)};
#else
    const Columns di;
    const auto last = hn::Set(di, kAtOnce - 1);
    const auto place = hn::IndicesFromVec(d, hn::And(element[tap], last));
    return hn::IfThenElse(hn::RebindMask(d, hn::Gt(element[tap], last)),
                          hn::TableLookupLanes(high, place), hn::TableLookupLanes(low, place));
#endif
  }
};

// Columns of taps that are on the surface, or replace those that are not. Branches per position
// would be mispredicted at surface ends and on rough surfaces.
HWY_INLINE TapColumns chosen_columns(const BicubicFetchRow& row, const Places& places,
                                     const hn::Mask<Values> (&on_surface)[4]) {
  const Values d;
  const Columns di;
  const TapColumns own = columns_at(places.whole);
  const auto& column = own.at;
  const auto first_half = hn::RebindMask(di, hn::Lt(places.fraction, hn::Set(d, 0.5F)));
  const auto at_left_border = hn::Lt(places.whole, hn::Zero(di));
  const auto at_right_border = hn::Eq(places.whole, hn::Set(di, row.width - 1));
  // Of taps 1 and 2, limited to the image.
  const auto nearest = hn::IfThenElse(
      hn::Or(hn::AndNot(at_left_border, first_half), at_right_border), column[1], column[2]);
  const auto on1 = hn::RebindMask(di, on_surface[1]);
  const auto on2 = hn::RebindMask(di, on_surface[2]);
  const auto inner1 = hn::IfThenElse(on1, column[1], hn::IfThenElse(on2, column[2], nearest));
  const auto inner2 = hn::IfThenElse(on2, column[2], hn::IfThenElse(on1, column[1], nearest));
  const auto outer0 = hn::And(on1, hn::RebindMask(di, on_surface[0]));
  const auto outer3 = hn::And(on2, hn::RebindMask(di, on_surface[3]));
  return {{hn::IfThenElse(outer0, column[0], inner1), inner1, inner2,
           hn::IfThenElse(outer3, column[3], inner2)}};
}

// Adds the colours of known places, whose taps are `taps`.
template <int kChannels, bool kInRange, class Taps>
HWY_INLINE void add_colours(const BicubicFetchRow& row, Vec fraction, hn::Mask<Values> known,
                            const Taps& taps, Vec (&colour)[kChannels]) {
  const Values d;
  const auto weights = keys_weights(d, fraction);
  const auto largest_value = hn::Set(d, row.largest_value);
  for (int c = 0; c < kChannels; ++c) {
    const float* plane = row.pixels + c * row.stride;
    const Vec value[4] = {taps.load(plane, 0), taps.load(plane, 1), taps.load(plane, 2),
                          taps.load(plane, 3)};
    colour[c] =
        hn::IfThenElse(known, interpolate<kInRange>(value, weights, largest_value), colour[c]);
  }
}

// Same with taps of the places as they are, some of which may be on another surface.
template <int kChannels, bool kInRange, class Taps>
HWY_INLINE void add_colours_on_surface(const BicubicFetchRow& row, const Places& places, int first,
                                       Vec disparity_px, hn::Mask<Values> known, const Taps& taps,
                                       Vec (&colour)[kChannels]) {
  const Values d;
  const auto limit = hn::Set(d, row.gradient_limit_px);
  const auto is_on_surface = [&](int tap) HWY_ATTR {
    return hn::Le(hn::Abs(hn::Sub(taps.load(row.source_disparity_px, tap), disparity_px)), limit);
  };
  const hn::Mask<Values> on_surface[4] = {is_on_surface(0), is_on_surface(1), is_on_surface(2),
                                          is_on_surface(3)};
  if (hn::AllTrue(d, hn::And(hn::And(on_surface[0], on_surface[1]),
                             hn::And(on_surface[2], on_surface[3])))) {
    add_colours<kChannels, kInRange>(row, places.fraction, known, taps, colour);
  } else {
    add_colours<kChannels, kInRange>(row, places.fraction, known,
                                     NearTaps(first, chosen_columns(row, places, on_surface)),
                                     colour);
  }
}

// Colours of positions n to n + kAtOnce with these disparities; 0 at holes.
template <int kChannels, bool kInRange>
HWY_INLINE void fetch_colours(const BicubicFetchRow& row, int n, Vec disparity_px,
                              Vec (&colour)[kChannels]) {
  const Values d;
  const Columns di;
  auto known = hn::Eq(disparity_px, disparity_px);
  const Places places = find_places(row, n, hn::IfThenElseZero(known, disparity_px));
  HWY_ALIGN std::int32_t whole[kAtOnce];
  hn::Store(places.whole, di, whole);
  for (Vec& of_channel : colour) {
    of_channel = hn::Zero(d);
  }
  // One surface after another, mostly a single one.
  while (!hn::AllFalse(d, known)) {
    const int column = whole[hn::FindFirstTrue(d, known)];
    // On a surface columns advance with positions: what two vectors hold more than the taps is
    // divided between both sides.
    constexpr int kRoom = (kAtOnce - 3) / 2;
    const int first = column - 1 - kRoom;
    const auto from_first = hn::Sub(places.whole, hn::Set(di, first + 1));
    const auto is_near = hn::And(
        known, hn::RebindMask(d, hn::And(hn::Gt(from_first, hn::Set(di, -1)),
                                         hn::Lt(from_first, hn::Set(di, 2 * kAtOnce - 3)))));
    if constexpr (kAtOnce < 16) {  // there, one instruction looks up two vectors
      const auto adjacent = hn::Add(hn::Iota(di, 0), hn::Set(di, column));
      if (hn::AllTrue(di, hn::Eq(places.whole, adjacent))) {
        add_colours_on_surface<kChannels, kInRange>(row, places, first, disparity_px, is_near,
                                                    AdjacentTaps{column - 1}, colour);
        break;
      }
    }
    add_colours_on_surface<kChannels, kInRange>(row, places, first, disparity_px, is_near,
                                                NearTaps(first, columns_at(places.whole)), colour);
    known = hn::AndNot(is_near, known);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // VANTAGE_KERNELS_BICUBIC_COLOURS_INL_H_
