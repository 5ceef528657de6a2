// Vectors of fixed-point energies. Included once per target by dispatched files.

#if defined(VANTAGE_KERNELS_CELLS_ENERGY_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VANTAGE_KERNELS_CELLS_ENERGY_VECTORS_INL_H_
#undef VANTAGE_KERNELS_CELLS_ENERGY_VECTORS_INL_H_
#else
#define VANTAGE_KERNELS_CELLS_ENERGY_VECTORS_INL_H_
#endif

#include <cstdint>

#include "kernels/candidates.h"
#include "kernels/cells/fixed_energy.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// At most kLaneMultiple lanes, so that columns are always whole vectors.
using EnergyTag = hn::CappedTag<FixedEnergy, kLaneMultiple>;
using EnergyVec = hn::VFromD<EnergyTag>;
inline constexpr int kEnergyLanes = static_cast<int>(hn::MaxLanes(EnergyTag()));

// Minimum over the lanes, in every lane.
template <class Vec>
HWY_INLINE Vec min_of_lanes(Vec energies) {
  const hn::DFromV<Vec> d;
  // Energies are not negative, so unsigned: processors find the minimum of eight unsigned words in
  // one instruction.
  const hn::CappedTag<std::uint16_t, 8> d8;
  const hn::RebindToSigned<decltype(d8)> signed8;
  if constexpr (hn::MaxLanes(hn::DFromV<Vec>()) == 16) {
    const auto half = hn::Min(hn::LowerHalf(signed8, energies), hn::UpperHalf(signed8, energies));
    const auto min = hn::BitCast(signed8, hn::MinOfLanes(d8, hn::BitCast(d8, half)));
    return hn::Combine(d, min, min);
  } else {
    return hn::BitCast(d, hn::MinOfLanes(d8, hn::BitCast(d8, energies)));
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
