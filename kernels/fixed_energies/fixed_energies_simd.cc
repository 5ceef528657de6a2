#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/fixed_energies/fixed_energies_simd.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, so that it is compiled once per target.
#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>

#include "kernels/cells/energy_vectors-inl.h"
#include "kernels/cells/exp_log-inl.h"
#include "kernels/fixed_energies/fixed_energies.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR
void of_bytes(const CompactRow& row, ByteSteps steps, FixedEnergy* energies) {
  fixed_energies_of_bytes_row_ref(row, steps, energies);
}
void of_likelihoods(const LikelihoodRow& row, float steps_per_nat, FixedEnergy* energies) {
  fixed_energies_of_likelihoods_row_ref(row, steps_per_nat, energies);
}
void to_bytes(const FixedEnergy* energies, int cells, FixedWeight bytes_per_step,
              std::uint8_t* bytes) {
  bytes_of_fixed_energies_row_ref(energies, cells, bytes_per_step, bytes);
}
#else

using ByteTag = hn::Rebind<std::uint8_t, EnergyTag>;

// Non-candidate lanes are first computed like the others, then overwritten here.
template <class Row>
HWY_INLINE void close_lanes(const Row& row, FixedEnergy* energies) {
  if (row.count < row.lanes) {
    for (int x = 0; x < row.columns; ++x, energies += row.lanes) {
      std::fill(energies + std::max(0, row.count), energies + row.lanes, kMaxEnergy);
    }
  }
}

void of_bytes(const CompactRow& row, ByteSteps steps, FixedEnergy* energies) {
  const EnergyTag d;
  const hn::RebindToUnsigned<EnergyTag> du;
  const EnergyVec units = hn::Set(d, steps.units());
  for (int k = 0; k < row.columns * row.lanes; k += kEnergyLanes) {
    // Fixed-point products lose 15 bits: 7 from the shift of bytes and 8 from ByteSteps.
    const auto bytes = hn::PromoteTo(du, hn::LoadU(ByteTag(), row.cells + k));
    const EnergyVec shifted = hn::BitCast(d, hn::ShiftLeft<7>(bytes));
    hn::StoreU(hn::MulFixedPoint15(shifted, units), d, energies + k);
  }
  close_lanes(row, energies);
}

void of_likelihoods(const LikelihoodRow& row, float steps_per_nat, FixedEnergy* energies) {
  const hn::ScalableTag<float> df;
  const hn::Rebind<FixedEnergy, decltype(df)> d16;
  const int step = static_cast<int>(hn::Lanes(df));
  const auto min = hn::Set(df, kMinFixedLikelihood);
  const auto scale = hn::Set(df, -steps_per_nat);
  for (int k = 0; k < row.columns * row.lanes; k += step) {
    const auto log = log_of_normal(hn::Max(hn::LoadU(df, row.cells + k), min));
    const auto steps = hn::Max(hn::Mul(log, scale), hn::Zero(df));
    hn::StoreU(hn::DemoteTo(d16, hn::NearestInt(steps)), d16, energies + k);
  }
  close_lanes(row, energies);
}

void to_bytes(const FixedEnergy* energies, int cells, FixedWeight bytes_per_step,
              std::uint8_t* bytes) {
  const EnergyTag d;
  const EnergyVec weight = hn::Set(d, bytes_per_step);
  for (int k = 0; k < cells; k += kEnergyLanes) {
    const EnergyVec steps = hn::MulFixedPoint15(hn::LoadU(d, energies + k), weight);
    hn::StoreU(hn::DemoteTo(ByteTag(), steps), ByteTag(), bytes + k);  // saturates
  }
}
#endif

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(of_bytes);
HWY_EXPORT(of_likelihoods);
HWY_EXPORT(to_bytes);

void fixed_energies_of_bytes_row(const CompactRow& row, ByteSteps steps, FixedEnergy* energies) {
  HWY_DYNAMIC_DISPATCH(of_bytes)(row, steps, energies);
}
void fixed_energies_of_likelihoods_row(const LikelihoodRow& row, float steps_per_nat,
                                       FixedEnergy* energies) {
  HWY_DYNAMIC_DISPATCH(of_likelihoods)(row, steps_per_nat, energies);
}
void bytes_of_fixed_energies_row(const FixedEnergy* energies, int cells, FixedWeight bytes_per_step,
                                 std::uint8_t* bytes) {
  HWY_DYNAMIC_DISPATCH(to_bytes)(energies, cells, bytes_per_step, bytes);
}

}  // namespace vantage::kernels
#endif
