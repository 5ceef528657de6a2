#include "kernels/simd-inl.h"

#include <algorithm>
#include <limits>

#include "kernels/colour_fetch/colour_fetch.h"
#include "kernels/keys_weights-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {
// Positions whose columns and weights are computed at a time; a multiple of every vector length.
constexpr int kBlock = 64;

// Vectors of several colour pixels.
using Pixels = hn::CappedTag<float, 16>;
constexpr int kPixelLanes = 4;
constexpr int kPixelsAtOnce = static_cast<int>(hn::MaxLanes(Pixels())) / kPixelLanes;

struct BlockWeights {
  std::int32_t whole[kBlock];  // floor of the column
  float fraction[kBlock];
  float weight[4][kBlock + hn::MaxLanes(Pixels())];  // read in whole vectors
};

// Source columns n + s·d and tap weights of `count` positions starting at `begin`; meaningless at
// holes.
template <class D64>
HWY_INLINE void weigh_taps(D64 d64, const BicubicFetchRow& row, int begin, int first, int count,
                           BlockWeights& block) {
  const hn::Rebind<float, D64> d32;
  const hn::Rebind<std::int32_t, D64> di32;
  const auto offset = hn::Set(d64, row.camera_offset);
  const auto min = hn::Set(d64, -1.0);
  const auto max = hn::Set(d64, row.width - 0.5);
  const int step = static_cast<int>(hn::Lanes(d64));
  for (int i = first; i + step <= count; i += step) {
    const auto read = hn::LoadU(d32, row.warped_disparity_px + begin + i);
    const auto d = hn::IfThenElseZero(hn::Eq(read, read), read);
    // Not Iota(d64, begin + i): only a constant start avoids a detour through memory.
    const auto position = hn::Add(hn::Iota(d64, 0), hn::Set(d64, begin + i));
    const auto exact = hn::Add(position, hn::Mul(offset, hn::PromoteTo(d64, d)));
    const auto column = hn::Min(hn::Max(exact, min), max);
    const auto whole = hn::Floor(column);
    hn::StoreU(hn::DemoteTo(di32, whole), di32, block.whole + i);
    const auto f = hn::DemoteTo(d32, hn::Sub(column, whole));
    hn::StoreU(f, d32, block.fraction + i);
    const auto weights = keys_weights(d32, f);
    hn::StoreU(weights.at[0], d32, block.weight[0] + i);
    hn::StoreU(weights.at[1], d32, block.weight[1] + i);
    hn::StoreU(weights.at[2], d32, block.weight[2] + i);
    hn::StoreU(weights.at[3], d32, block.weight[3] + i);
  }
}

constexpr int kGroup = 4;  // positions whose taps are processed together
using Group = hn::FixedTag<float, kGroup>;
using GroupInt = hn::FixedTag<std::int32_t, kGroup>;
using GroupVec = hn::VFromD<Group>;
using GroupMask = hn::MFromD<Group>;

// Four values at each of four positions: tap k of all positions is in element k.
struct FourTaps {
  GroupVec tap[4];
};

HWY_INLINE FourTaps load_taps(const float* row, const std::int32_t* HWY_RESTRICT first) {
  const Group d;
  const auto a = hn::LoadU(d, row + first[0] - 1);
  const auto b = hn::LoadU(d, row + first[1] - 1);
  const auto c = hn::LoadU(d, row + first[2] - 1);
  const auto e = hn::LoadU(d, row + first[3] - 1);
  const auto even_low = hn::InterleaveLower(d, a, c);
  const auto odd_low = hn::InterleaveLower(d, b, e);
  const auto even_high = hn::InterleaveUpper(d, a, c);
  const auto odd_high = hn::InterleaveUpper(d, b, e);
  return {{hn::InterleaveLower(d, even_low, odd_low), hn::InterleaveUpper(d, even_low, odd_low),
           hn::InterleaveLower(d, even_high, odd_high),
           hn::InterleaveUpper(d, even_high, odd_high)}};
}

// Selects where taps come from. Branches would be mispredicted at surface ends and on rough
// surfaces.
struct TapChoice {
  GroupMask own0;      // taps 0 and 1 are on the surface; else tap 0 copies tap 1
  GroupMask own1;      // tap 1 is; else it copies tap 2, or the nearest where `neither`
  GroupMask own2;      // tap 2 is; else it copies tap 1
  GroupMask own3;      // taps 2 and 3 are; else tap 3 copies tap 2
  GroupMask neither;   // neither tap 1 nor tap 2 is
  GroupMask nearest1;  // of taps 1 and 2, limited to the image, tap 1 is nearest
};

HWY_INLINE TapChoice choose_taps(const BicubicFetchRow& row, const BlockWeights& block, int i,
                                 GroupVec disparity_px) {
  const Group d;
  const GroupInt d_int;
  const FourTaps taps = load_taps(row.source_disparity_px, block.whole + i);
  const auto limit = hn::Set(d, row.gradient_limit_px);
  const auto on_surface = [&](GroupVec tap) HWY_ATTR {
    return hn::Le(hn::Abs(hn::Sub(tap, disparity_px)), limit);
  };
  const auto on_surface1 = on_surface(taps.tap[1]);
  const auto on_surface2 = on_surface(taps.tap[2]);
  const auto whole = hn::LoadU(d_int, block.whole + i);
  const auto first_half = hn::Lt(hn::LoadU(d, block.fraction + i), hn::Set(d, 0.5F));
  const auto at_left_border = hn::RebindMask(d, hn::Lt(whole, hn::Zero(d_int)));
  const auto at_right_border =
      hn::RebindMask(d, hn::Eq(whole, hn::Set(d_int, static_cast<std::int32_t>(row.width - 1))));
  return {hn::And(on_surface(taps.tap[0]), on_surface1),
          on_surface1,
          on_surface2,
          hn::And(on_surface(taps.tap[3]), on_surface2),
          hn::Not(hn::Or(on_surface1, on_surface2)),
          hn::Or(hn::AndNot(at_left_border, first_half), at_right_border)};
}

// Applies a choice to the four taps' contents: values or columns.
template <class V, class M>
HWY_INLINE void apply_choice(const M (&own)[4], M neither, M nearest1, V (&tap)[4]) {
  const auto nearest = hn::IfThenElse(nearest1, tap[1], tap[2]);
  const auto tap1 = hn::IfThenElse(own[1], tap[1], hn::IfThenElse(neither, nearest, tap[2]));
  const auto tap2 = hn::IfThenElse(own[2], tap[2], hn::IfThenElse(neither, nearest, tap[1]));
  tap[0] = hn::IfThenElse(own[0], tap[0], tap1);
  tap[3] = hn::IfThenElse(own[3], tap[3], tap2);
  tap[1] = tap1;
  tap[2] = tap2;
}

// Weighted taps, clamped to the range of values. kInRange: all taps lie within the pixel type's
// range.
template <bool kInRange, class D, class V>
HWY_INLINE V interpolate(D d, const V (&value)[4], const V (&weight)[4], V largest_value) {
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

// One value per position: the group's four positions form a vector.
template <bool kInRange>
HWY_INLINE void fetch_grey_group(const BicubicFetchRow& row, const BlockWeights& block, int i,
                                 GroupVec disparity_px, float* HWY_RESTRICT colours) {
  const Group d;
  const TapChoice choice = choose_taps(row, block, i, disparity_px);
  FourTaps values = load_taps(row.pixels, block.whole + i);
  const GroupMask own[4] = {choice.own0, choice.own1, choice.own2, choice.own3};
  apply_choice(own, choice.neither, choice.nearest1, values.tap);
  const GroupVec weight[4] = {hn::LoadU(d, block.weight[0] + i), hn::LoadU(d, block.weight[1] + i),
                              hn::LoadU(d, block.weight[2] + i), hn::LoadU(d, block.weight[3] + i)};
  const auto colour = interpolate<kInRange>(d, values.tap, weight, hn::Set(d, row.largest_value));
  hn::StoreU(hn::IfThenElseZero(hn::Eq(disparity_px, disparity_px), colour), d, colours);
}

// The pixels at these addresses, one after another in a vector.
template <class D>
HWY_INLINE hn::VFromD<D> load_pixels(D d, const float* const* pixels) {
  constexpr int kPixels = static_cast<int>(hn::MaxLanes(d)) / kPixelLanes;
  if constexpr (kPixels == 1) {
    return hn::LoadU(d, pixels[0]);
  } else {
    const hn::Half<D> half;
    return hn::Combine(d, load_pixels(half, pixels + kPixels / 2), load_pixels(half, pixels));
  }
}

// The weight of each pixel of a vector in all its lanes.
HWY_INLINE hn::VFromD<Pixels> spread_weights(const float* weights) {
  const Pixels d;
  const hn::RebindToSigned<Pixels> di;
  const auto pixel_of_lane = hn::ShiftRight<2>(hn::Iota(di, 0));
  return hn::TableLookupLanes(hn::LoadU(d, weights), hn::IndicesFromVec(d, pixel_of_lane));
}

// Interpolates the pixels of a vector; load_tap(k) returns their taps k.
template <bool kInRange, class LoadTap>
HWY_INLINE void fetch_inside(const BicubicFetchRow& row, const BlockWeights& block, int i,
                             const LoadTap& load_tap, float* HWY_RESTRICT colours) {
  const Pixels d;
  const hn::VFromD<Pixels> value[4] = {load_tap(0), load_tap(1), load_tap(2), load_tap(3)};
  const hn::VFromD<Pixels> weight[4] = {
      spread_weights(block.weight[0] + i), spread_weights(block.weight[1] + i),
      spread_weights(block.weight[2] + i), spread_weights(block.weight[3] + i)};
  hn::StoreU(interpolate<kInRange>(d, value, weight, hn::Set(d, row.largest_value)), d, colours);
}

constexpr int kRun = 16;  // positions

// Whether positions i to i + kRun of a block show adjacent columns of one surface: all taps count,
// and each tap of the run is a stretch of the source row.
HWY_INLINE bool is_run_on_surface(const BicubicFetchRow& row, const BlockWeights& block, int begin,
                                  int i) {
  const hn::CappedTag<float, kRun> d;
  const hn::RebindToSigned<decltype(d)> di;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(d));
  const std::int32_t first = block.whole[i];
  if (block.whole[i + kRun - 1] != first + kRun - 1) {
    return false;
  }
  const auto limit = hn::Set(d, row.gradient_limit_px);
  for (int k = 0; k < kRun; k += kLanes) {
    const auto expected = hn::Add(hn::Iota(di, 0), hn::Set(di, first + k));
    const auto own = hn::LoadU(d, row.warped_disparity_px + begin + i + k);
    auto good = hn::RebindMask(d, hn::Eq(hn::LoadU(di, block.whole + i + k), expected));
    const float* taps = row.source_disparity_px + first + k;
    for (int tap = -1; tap <= 2; ++tap) {
      good = hn::And(good, hn::Le(hn::Abs(hn::Sub(hn::LoadU(d, taps + tap), own)), limit));
    }
    if (!hn::AllTrue(d, good)) {
      return false;
    }
  }
  return true;
}

// Colours of such a run.
template <bool kInRange>
HWY_INLINE void fetch_run(const BicubicFetchRow& row, const BlockWeights& block, int i,
                          float* HWY_RESTRICT colours) {
  const float* pixels = row.pixels + (block.whole[i] - 1) * kPixelLanes;
  for (int k = 0; k < kRun; k += kPixelsAtOnce) {
    const auto load_tap = [&](int tap) HWY_ATTR {
      return hn::LoadU(Pixels(), pixels + (k + tap) * kPixelLanes);
    };
    fetch_inside<kInRange>(row, block, i + k, load_tap, colours + k * kPixelLanes);
  }
}

// Four values per position: a vector is one pixel; its taps are adjacent in memory.
template <bool kInRange>
HWY_INLINE void fetch_colour_group(const BicubicFetchRow& row, const BlockWeights& block, int i,
                                   GroupVec disparity_px, float* HWY_RESTRICT colours) {
  const Group d;
  const GroupInt d_int;
  const auto largest_value = hn::Set(d, row.largest_value);
  const auto fetch_pixel = [&](int p, const GroupVec(&value)[4]) HWY_ATTR {
    const GroupVec weight[4] = {
        hn::Set(d, block.weight[0][i + p]), hn::Set(d, block.weight[1][i + p]),
        hn::Set(d, block.weight[2][i + p]), hn::Set(d, block.weight[3][i + p])};
    return interpolate<kInRange>(d, value, weight, largest_value);
  };
  const TapChoice choice = choose_taps(row, block, i, disparity_px);
  if (hn::AllTrue(d, hn::And(choice.own0, choice.own3))) {
    // Inside a surface, so no position is a hole.
    for (int p = 0; p < kGroup; p += kPixelsAtOnce) {
      const auto load_tap = [&](int tap) HWY_ATTR {
        const float* pixels[kGroup];
        for (int q = 0; q < kGroup; ++q) {
          pixels[q] = row.pixels + (block.whole[i + q] - 1 + tap) * kPixelLanes;
        }
        return load_pixels(Pixels(), pixels + p);
      };
      fetch_inside<kInRange>(row, block, i + p, load_tap, colours + p * kPixelLanes);
    }
    return;
  }
  const auto whole = hn::LoadU(d_int, block.whole + i);
  const auto one = hn::Set(d_int, 1);
  hn::VFromD<GroupInt> columns[4] = {hn::Sub(whole, one), whole, hn::Add(whole, one),
                                     hn::Add(whole, hn::Add(one, one))};
  const hn::MFromD<GroupInt> own[4] = {
      hn::RebindMask(d_int, choice.own0), hn::RebindMask(d_int, choice.own1),
      hn::RebindMask(d_int, choice.own2), hn::RebindMask(d_int, choice.own3)};
  apply_choice(own, hn::RebindMask(d_int, choice.neither), hn::RebindMask(d_int, choice.nearest1),
               columns);
  HWY_ALIGN std::int32_t places[4][kGroup];
  HWY_ALIGN float disparities[kGroup];
  for (int k = 0; k < 4; ++k) {
    hn::Store(hn::ShiftLeft<2>(columns[k]), d_int, places[k]);
  }
  hn::Store(disparity_px, d, disparities);
  for (int p = 0; p < kGroup; ++p) {
    const GroupVec value[4] = {
        hn::LoadU(d, row.pixels + places[0][p]), hn::LoadU(d, row.pixels + places[1][p]),
        hn::LoadU(d, row.pixels + places[2][p]), hn::LoadU(d, row.pixels + places[3][p])};
    const auto known = hn::Set(d, disparities[p]);
    const auto colour = hn::IfThenElseZero(hn::Eq(known, known), fetch_pixel(p, value));
    hn::StoreU(colour, d, colours + p * 4);
  }
}

template <int kLanes, bool kInRange>
HWY_INLINE void fetch_any(const BicubicFetchRow& given, float* HWY_RESTRICT colours) {
  const BicubicFetchRow row = given;  // a copy: stores to colours cannot alias it
  const hn::ScalableTag<double> d64;
  const hn::FixedTag<double, 1> d64_one;
  const Group d;
  HWY_ALIGN BlockWeights block;
  for (int begin = 0; begin < row.width; begin += kBlock) {
    const int count = std::min(kBlock, row.width - begin);
    const int whole_vectors = count - count % static_cast<int>(hn::Lanes(d64));
    weigh_taps(d64, row, begin, 0, whole_vectors, block);
    weigh_taps(d64_one, row, begin, whole_vectors, count, block);
    const auto fetch = [&](int i, GroupVec disparity_px, float* to) HWY_ATTR {
      if constexpr (kLanes == 1) {
        fetch_grey_group<kInRange>(row, block, i, disparity_px, to);
      } else {
        fetch_colour_group<kInRange>(row, block, i, disparity_px, to);
      }
    };
    int i = 0;
    while (i + kGroup <= count) {
      if constexpr (kLanes == kPixelLanes) {
        if (i + kRun <= count && is_run_on_surface(row, block, begin, i)) {
          fetch_run<kInRange>(row, block, i, colours + (begin + i) * kLanes);
          i += kRun;
          continue;
        }
      }
      fetch(i, hn::LoadU(d, row.warped_disparity_px + begin + i), colours + (begin + i) * kLanes);
      i += kGroup;
    }
    if (i < count) {
      // Partial group: the positions after its end are holes.
      HWY_ALIGN float disparity_px[kGroup];
      HWY_ALIGN float last_colours[kGroup * kLanes];
      for (int p = 0; p < kGroup; ++p) {
        const bool is_there = i + p < count;
        disparity_px[p] = is_there ? row.warped_disparity_px[begin + i + p]
                                   : std::numeric_limits<float>::quiet_NaN();
        if (!is_there) {
          block.whole[i + p] = 0;
        }
      }
      fetch(i, hn::Load(d, disparity_px), last_colours);
      std::copy_n(last_colours, (count - i) * kLanes, colours + (begin + i) * kLanes);
    }
  }
}

void fetch_bicubic(const BicubicFetchRow& row, float* colours) {
  if (row.lanes == 1) {
    row.is_in_range ? fetch_any<1, true>(row, colours) : fetch_any<1, false>(row, colours);
  } else {
    row.is_in_range ? fetch_any<4, true>(row, colours) : fetch_any<4, false>(row, colours);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(fetch_bicubic);

void fetch_bicubic_row(const BicubicFetchRow& row, float* colours) {
  HWY_DYNAMIC_DISPATCH(fetch_bicubic)(row, colours);
}

}  // namespace vantage::kernels
#endif
