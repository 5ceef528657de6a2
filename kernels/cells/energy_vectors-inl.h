// Vectors of energies in fixed point; included by dispatched files, once per target.

#if defined(VANTAGE_KERNELS_CELLS_ENERGY_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VANTAGE_KERNELS_CELLS_ENERGY_VECTORS_INL_H_
#undef VANTAGE_KERNELS_CELLS_ENERGY_VECTORS_INL_H_
#else
#define VANTAGE_KERNELS_CELLS_ENERGY_VECTORS_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "kernels/candidates.h"
#include "kernels/cells/fixed_energy.h"

#if HWY_TARGET != HWY_SCALAR
HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// At most kLaneMultiple lanes: columns are whole vectors everywhere.
using EnergyTag = hwy::HWY_NAMESPACE::CappedTag<FixedEnergy, kLaneMultiple>;
using EnergyVec = hwy::HWY_NAMESPACE::VFromD<EnergyTag>;
inline constexpr int kEnergyLanes = static_cast<int>(hwy::HWY_NAMESPACE::MaxLanes(EnergyTag()));

// The least lane, in every lane.
template <class Vec>
HWY_INLINE Vec least_of_lanes(Vec energies) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::DFromV<Vec> d;
  // Energies are not negative: unsigned numbers, of which processors find the least in one step,
  // eight at a time.
  const hn::CappedTag<std::uint16_t, 8> d8;
  const hn::RebindToSigned<decltype(d8)> signed8;
  if constexpr (hn::MaxLanes(hn::DFromV<Vec>()) == 16) {
    const auto half = hn::Min(hn::LowerHalf(signed8, energies), hn::UpperHalf(signed8, energies));
    const auto least = hn::BitCast(signed8, hn::MinOfLanes(d8, hn::BitCast(d8, half)));
    return hn::Combine(d, least, least);
  } else {
    return hn::BitCast(d, hn::MinOfLanes(d8, hn::BitCast(d8, energies)));
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif
