#include "kernels/simd-inl.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "kernels/map_enlargement/map_enlargement.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using TagF = hn::ScalableTag<float>;
using TagI = hn::RebindToSigned<TagF>;
using VecF = hn::VFromD<TagF>;
using VecI = hn::VFromD<TagI>;
using MaskF = decltype(hn::Gt(VecF(), VecF()));
constexpr int kColumns = static_cast<int>(hn::MaxLanes(TagF()));

HWY_INLINE VecI integers(const std::uint8_t* bytes) {
  const hn::Rebind<std::uint8_t, TagF> d8;
  return hn::PromoteTo(TagI(), hn::LoadU(d8, bytes));
}

// Disparities of one column for each lane, their differences to the pixels' own, and where they are
// of another surface.
struct Neighbour {
  VecF px;
  VecF step;
  MaskF is_other;
};

HWY_INLINE Neighbour neighbour_of(const float* px, VecF own) {
  const TagF d;
  const VecF value = hn::LoadU(d, px);
  const VecF step = hn::Sub(value, own);
  return {value, step, hn::Gt(hn::Abs(step), hn::Set(d, kEnlargedSurfaceStepPx))};
}

// A quarter of the way to a neighbour of the same surface; 0 for unknown ones.
HWY_INLINE VecF quarter(const Neighbour& neighbour) {
  const TagF d;
  const auto is_same = hn::Le(hn::Abs(neighbour.step), hn::Set(d, kEnlargedSurfaceStepPx));
  return hn::IfThenElseZero(is_same, hn::Mul(neighbour.step, hn::Set(d, 0.25F)));
}

// The disparity of the neighbour that looks most like the pixels, or `smooth`.
struct Choice {
  VecF px;
  VecI nearest;
  VecI intensity;

  Choice(VecF smooth, VecI of_pixel, VecI of_own)
      : px(smooth),
        nearest(hn::Sub(hn::Abs(hn::Sub(of_pixel, of_own)), hn::Set(TagI(), kEnlargedPreference))),
        intensity(of_pixel) {}
  HWY_INLINE void consider(const Neighbour& neighbour, VecI of_neighbour) {
    const TagF d;
    const TagI di;
    const VecI difference = hn::Abs(hn::Sub(intensity, of_neighbour));
    const auto wins = hn::And(neighbour.is_other, hn::RebindMask(d, hn::Lt(difference, nearest)));
    nearest = hn::IfThenElse(hn::RebindMask(di, wins), difference, nearest);
    px = hn::IfThenElse(wins, neighbour.px, px);
  }
};

// The pixels on one side of `column`, of which `beside` is −1 or 1 columns away.
HWY_INLINE VecF enlarged(const EnlargedRow& row, int column, int beside, VecF own,
                         const Neighbour& other_row, VecI intensity) {
  const Neighbour in_row = neighbour_of(row.own_px + column + beside, own);
  const Neighbour diagonal = neighbour_of(row.beside_px + column + beside, own);
  const VecF smooth = hn::Add(own, hn::Add(quarter(in_row), quarter(other_row)));
  if (hn::AllFalse(TagF(),
                   hn::Or(hn::Or(in_row.is_other, other_row.is_other), diagonal.is_other))) {
    return smooth;
  }
  Choice choice(smooth, intensity, integers(row.own_intensities + column));
  choice.consider(in_row, integers(row.own_intensities + column + beside));
  choice.consider(other_row, integers(row.beside_intensities + column));
  choice.consider(diagonal, integers(row.beside_intensities + column + beside));
  return choice.px;
}

// The pixels of kColumns columns, all with neighbours on both sides.
HWY_INLINE void enlarge_columns(const EnlargedRow& row, int column, float* disparity_px) {
  const TagF d;
  const VecF own = hn::LoadU(d, row.own_px + column);
  const Neighbour other_row = neighbour_of(row.beside_px + column, own);
  // Pairs of pixels, the left one in the low byte.
  HWY_ALIGN std::uint16_t pairs[kColumns];
  std::memcpy(pairs, row.intensities + 2 * column, sizeof(pairs));
  const VecI pair = hn::PromoteTo(TagI(), hn::Load(hn::Rebind<std::uint16_t, TagF>(), pairs));
  const VecI left_intensity = hn::And(pair, hn::Set(TagI(), 0xFF));
  const VecI right_intensity = hn::ShiftRight<8>(pair);
  const VecF left = enlarged(row, column, -1, own, other_row, left_intensity);
  const VecF right = enlarged(row, column, 1, own, other_row, right_intensity);
  hn::StoreInterleaved2(left, right, d, disparity_px + 2 * column);
}

void enlarge(const EnlargedRow& row, float* disparity_px) {
  // Columns [1, end) have neighbours on both sides.
  const int end = (row.width + 1) / 2 - 1;
  if (end - 1 < kColumns) {
    enlarge_map_row_ref(row, 0, row.width, disparity_px);
    return;
  }
  enlarge_map_row_ref(row, 0, 2, disparity_px);
  int column = 1;
  for (; column + kColumns <= end; column += kColumns) {
    enlarge_columns(row, column, disparity_px);
  }
  enlarge_columns(row, end - kColumns, disparity_px);
  enlarge_map_row_ref(row, 2 * end, row.width, disparity_px);
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(enlarge);

void enlarge_map_row(const EnlargedRow& row, float* disparity_px) {
  HWY_DYNAMIC_DISPATCH(enlarge)(row, disparity_px);
}

// Scalar reference.

void enlarge_map_row_ref(const EnlargedRow& row, int begin, int end, float* disparity_px) {
  const int last = (row.width - 1) / 2;
  for (int x = begin; x < end; ++x) {
    const int own = x / 2;
    const int beside = std::clamp(x % 2 == 0 ? own - 1 : own + 1, 0, last);
    const float value = row.own_px[own];
    const auto difference = [&](std::uint8_t intensity) {
      return std::abs(row.intensities[x] - intensity);
    };
    const auto quarter = [&](float other) {
      const float step = other - value;
      return std::fabs(step) <= kEnlargedSurfaceStepPx ? step * 0.25F : 0.0F;
    };
    float result = value + (quarter(row.own_px[beside]) + quarter(row.beside_px[own]));
    int nearest = difference(row.own_intensities[own]) - kEnlargedPreference;
    const auto consider = [&](float other, std::uint8_t intensity) {
      if (std::fabs(other - value) > kEnlargedSurfaceStepPx && difference(intensity) < nearest) {
        nearest = difference(intensity);
        result = other;
      }
    };
    consider(row.own_px[beside], row.own_intensities[beside]);
    consider(row.beside_px[own], row.beside_intensities[own]);
    consider(row.beside_px[beside], row.beside_intensities[beside]);
    disparity_px[x] = result;
  }
}

}  // namespace vantage::kernels
#endif
