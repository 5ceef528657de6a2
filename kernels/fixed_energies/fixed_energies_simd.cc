#include "kernels/simd-inl.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "kernels/cells/energy_vectors-inl.h"
#include "kernels/cells/exp_log-inl.h"
#include "kernels/cells/exp_log.h"
#include "kernels/fixed_energies/fixed_energies.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using ByteTag = hn::Rebind<std::uint8_t, EnergyTag>;

// Calls store(cells, energies) for each vector of `step` lanes.
template <class Row, class Store>
HWY_INLINE void each_vector(const Row& row, int step, FixedEnergy* energies, EnergyPitches pitches,
                            const Store& store) {
  const std::ptrdiff_t from = pitches.cells > 0 ? pitches.cells : row.lanes;
  const std::ptrdiff_t to = pitches.energies > 0 ? pitches.energies : row.lanes;
  const bool is_contiguous = from == row.lanes && to == row.lanes;
  const int columns = is_contiguous ? 1 : row.columns;
  const int lanes = is_contiguous ? row.columns * row.lanes : row.lanes;
  for (int x = 0; x < columns; ++x) {
    const auto* const cells = row.cells + x * from;
    FixedEnergy* const of_column = energies + x * to;
    for (int lane = 0; lane < lanes; lane += step) {
      store(cells + lane, of_column + lane);
    }
  }
  // Non-candidate lanes were computed like the others.
  for (int x = 0; row.count < row.lanes && x < row.columns; ++x) {
    FixedEnergy* const of_column = energies + x * to;
    std::fill(of_column + std::max(0, row.count), of_column + row.lanes, kMaxEnergy);
  }
}

void of_bytes(const CompactRow& row, ByteSteps steps, FixedEnergy* energies,
              EnergyPitches pitches) {
  const EnergyTag d;
  const hn::RebindToUnsigned<EnergyTag> du;
  const EnergyVec units = hn::Set(d, steps.units());
  const auto store = [&](const std::uint8_t* cells, FixedEnergy* to) HWY_ATTR {
    // Fixed-point products lose 15 bits: 7 from the shift of bytes and 8 from ByteSteps.
    const auto bytes = hn::PromoteTo(du, hn::LoadU(ByteTag(), cells));
    const EnergyVec shifted = hn::BitCast(d, hn::ShiftLeft<7>(bytes));
    hn::StoreU(hn::MulFixedPoint15(shifted, units), d, to);
  };
  each_vector(row, kEnergyLanes, energies, pitches, store);
}

void of_likelihoods(const LikelihoodRow& row, float steps_per_nat, FixedEnergy* energies,
                    EnergyPitches pitches) {
  const hn::ScalableTag<float> df;
  const hn::Rebind<FixedEnergy, decltype(df)> d16;
  const int step = static_cast<int>(hn::Lanes(df));
  const auto min = hn::Set(df, kMinFixedLikelihood);
  const auto scale = hn::Set(df, -steps_per_nat);
  const auto store = [&](const float* cells, FixedEnergy* to) HWY_ATTR {
    const auto log = log_of_normal(hn::Max(hn::LoadU(df, cells), min));
    const auto steps = hn::Max(hn::Mul(log, scale), hn::Zero(df));
    hn::StoreU(hn::DemoteTo(d16, hn::NearestInt(steps)), d16, to);
  };
  each_vector(row, step, energies, pitches, store);
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

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(of_bytes);
HWY_EXPORT(of_likelihoods);
HWY_EXPORT(to_bytes);

void fixed_energies_of_bytes_row(const CompactRow& row, ByteSteps steps, FixedEnergy* energies,
                                 EnergyPitches pitches) {
  HWY_DYNAMIC_DISPATCH(of_bytes)(row, steps, energies, pitches);
}
void fixed_energies_of_likelihoods_row(const LikelihoodRow& row, float steps_per_nat,
                                       FixedEnergy* energies, EnergyPitches pitches) {
  HWY_DYNAMIC_DISPATCH(of_likelihoods)(row, steps_per_nat, energies, pitches);
}
void bytes_of_fixed_energies_row(const FixedEnergy* energies, int cells, FixedWeight bytes_per_step,
                                 std::uint8_t* bytes) {
  HWY_DYNAMIC_DISPATCH(to_bytes)(energies, cells, bytes_per_step, bytes);
}

}  // namespace vantage::kernels
#endif
