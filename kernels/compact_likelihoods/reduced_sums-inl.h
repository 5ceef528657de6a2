// Sums of byte energies over blocks, and the energies they become. Included once per target by
// dispatched files.

#if defined(VANTAGE_KERNELS_REDUCED_SUMS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VANTAGE_KERNELS_REDUCED_SUMS_INL_H_
#undef VANTAGE_KERNELS_REDUCED_SUMS_INL_H_
#else
#define VANTAGE_KERNELS_REDUCED_SUMS_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "kernels/cells/byte_cells-inl.h"
#include "kernels/compact_likelihoods/compact_likelihoods.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using SumTag = hn::CappedTag<std::uint16_t, 8>;

// Calls body(d, lane) for the vectors of bytes that make up a column: the widest ones that fit.
template <class Body>
HWY_INLINE void each_lane_vector(int lanes, const Body& body) {
  int lane = 0;
  const auto while_it_fits = [&](auto d) HWY_ATTR {
    const int step = static_cast<int>(hn::Lanes(d));
    for (; lane + step <= lanes; lane += step) {
      body(d, lane);
    }
  };
  while_it_fits(hn::ScalableTag<std::uint8_t>());
  while_it_fits(hn::CappedTag<std::uint8_t, 32>());
  while_it_fits(hn::CappedTag<std::uint8_t, kLaneMultiple>());
}

// Minimum per lane over the 128-bit blocks.
template <class D16>
HWY_INLINE VecOf<SumTag> fold_min(D16, VecOf<D16> sums) {
  if constexpr (hn::MaxLanes(D16()) == hn::MaxLanes(SumTag())) {
    return sums;
  } else {
    const hn::Half<D16> half;
    return fold_min(half, hn::Min(hn::LowerHalf(half, sums), hn::UpperHalf(half, sums)));
  }
}

// energies = (sums − bottom) · units / kCompactWeightUnits. Sums are in the vectors of
// each_lane_vector(): first those of its even lanes, then those of its odd ones.
HWY_INLINE void weigh_sums(const std::uint16_t* sums, int lanes, std::uint16_t bottom,
                           std::int16_t units, std::uint8_t* energies) {
  each_lane_vector(lanes, [&](auto d, int lane) HWY_ATTR {
    using D8 = decltype(d);
    const Tag16<D8> d16;
    const hn::RebindToSigned<Tag16<D8> > di16;
    const auto of_bottom = hn::Set(d16, bottom);
    const auto factor = hn::Set(di16, units);
    const auto max = hn::Set(d16, static_cast<std::uint16_t>(kMaxCompact));
    // At most 4 · 255, doubled: the product's fixed point is at 2^15.
    const auto energy = [&](const std::uint16_t* of_lanes) HWY_ATTR {
      const auto above = hn::ShiftLeft<1>(hn::Sub(hn::LoadU(d16, of_lanes), of_bottom));
      const auto product = hn::MulFixedPoint15(hn::BitCast(di16, above), factor);
      return hn::Min(hn::BitCast(d16, product), max);
    };
    const auto even = energy(sums + lane);
    const auto odd = energy(sums + lane + hn::Lanes(d16));
    hn::StoreU(hn::BitCast(d, hn::Or(even, hn::ShiftLeft<8>(odd))), d, energies + lane);
  });
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
