#include "kernels/simd-inl.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "kernels/cells/energy_vectors-inl.h"
#include "kernels/cells/exp_log-inl.h"
#include "kernels/cells/lane_sums-inl.h"
#include "kernels/energy_winner/energy_winner.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// 0, 1, … per lane.
HWY_INLINE EnergyVec energy_lane_numbers() {
  alignas(32) static constexpr FixedEnergy numbers[kLaneMultiple] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                                     8, 9, 10, 11, 12, 13, 14, 15};
  return hn::Load(EnergyTag(), numbers);
}

// Minimum energy among the candidates of one column and its first position. kAll: every candidate
// counts, and no other lane is below them.
template <bool kAll>
HWY_INLINE void select(const FixedEnergy* cells, int lanes, CandidateRange candidates,
                       std::int32_t& winner, FixedEnergy& min) {
  const EnergyTag d;
  const EnergyVec max = hn::Set(d, kMaxEnergy);
  const EnergyVec before = hn::Set(d, static_cast<FixedEnergy>(candidates.begin - 1));
  const EnergyVec end = hn::Set(d, static_cast<FixedEnergy>(candidates.end));
  const auto load = [&](int lane) HWY_ATTR {
    const EnergyVec energies = hn::Load(d, cells + lane);
    if constexpr (kAll) {
      return energies;
    } else {
      const EnergyVec number =
          hn::Add(energy_lane_numbers(), hn::Set(d, static_cast<FixedEnergy>(lane)));
      const auto counts = hn::And(hn::Gt(number, before), hn::Lt(number, end));
      return hn::IfThenElse(counts, energies, max);
    }
  };
  EnergyVec lowest = max;
  for (int lane = 0; lane < lanes; lane += kEnergyLanes) {
    lowest = hn::Min(lowest, load(lane));
  }
  lowest = min_of_lanes(lowest);
  min = hn::GetLane(lowest);
  constexpr int kMaskLanes = 64;
  if (lanes <= kMaskLanes) {
    std::uint64_t places = 0;
    for (int lane = 0; lane < lanes; lane += kEnergyLanes) {
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(d, hn::Eq(load(lane), lowest), bits);
      std::uint64_t of_vector = 0;
      std::memcpy(&of_vector, bits, kEnergyLanes / 8);
      places |= of_vector << lane;
    }
    winner = std::max<std::int32_t>(std::countr_zero(places), candidates.begin);
    return;
  }
  // Reads all lanes: the winner's position is as good as random, and a mispredicted branch costs
  // more than the vectors.
  EnergyVec place = max;
  EnergyVec number = energy_lane_numbers();
  for (int lane = 0; lane < lanes; lane += kEnergyLanes) {
    place = hn::Min(place, hn::IfThenElse(hn::Eq(load(lane), lowest), number, max));
    number = hn::Add(number, hn::Set(d, kEnergyLanes));
  }
  // If the minimum is kMaxEnergy, lanes that do not count hold it too.
  winner = std::max<std::int32_t>(hn::GetLane(min_of_lanes(place)), candidates.begin);
}

void winners(const EnergyRow& row, std::int32_t* indices, FixedEnergy* min) {
  const CandidateRange plain = row.plain_columns();
  const int lanes = row.geometry.lanes();
  for (int j = 0; j < row.columns; ++j) {
    const int x = row.first_column + j;
    const FixedEnergy* const cells = row.cells + j * row.pitch;
    if (x >= plain.begin && x < plain.end) {
      select<true>(cells, lanes, {0, row.geometry.count}, indices[j], min[j]);
    } else if (const CandidateRange candidates = row.candidates(x); !candidates.empty()) {
      select<false>(cells, lanes, candidates, indices[j], min[j]);
    } else {
      indices[j] = kNoWinner;
      min[j] = kMaxEnergy;
    }
  }
}

void probabilities(const EnergyColumnsRow& row, const FixedEnergy* min, float steps_per_nat,
                   float* probability) {
  const FloatTag df;
  const hn::Rebind<FixedEnergy, FloatTag> d16;
  const hn::RebindToSigned<FloatTag> d32;
  const FloatVec exponent_of_step = hn::Set(df, -kLog2E / steps_per_nat);
  for (int j = 0; j < row.columns; ++j) {
    const FixedEnergy* const cells = row.cells + j * row.pitch;
    LaneBlock16 sums;
    sums.fill(hn::Zero(df));
    for (int lane = 0; lane < row.lanes; lane += kLaneMultiple) {
      for (int part = 0; part < kParts; ++part) {
        const auto energies = hn::PromoteTo(d32, hn::LoadU(d16, cells + lane + part * kFloatLanes));
        const FloatVec exponent = hn::Mul(hn::ConvertTo(df, energies), exponent_of_step);
        sums.part[part] = hn::Add(sums.part[part], exp2_of_negative(exponent));
      }
    }
    const FloatVec winner =
        exp2_of_negative(hn::Mul(hn::Set(df, static_cast<float>(min[j])), exponent_of_step));
    probability[j] = min[j] == kMaxEnergy ? std::numeric_limits<float>::quiet_NaN()
                                          : hn::GetLane(hn::Div(winner, sum_lanes(sums)));
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(winners);
HWY_EXPORT(probabilities);

void select_energy_winners_row(const EnergyRow& row, std::int32_t* indices, FixedEnergy* min) {
  HWY_DYNAMIC_DISPATCH(winners)(row, indices, min);
}
void energy_probability_row(const EnergyColumnsRow& row, const FixedEnergy* min,
                            float steps_per_nat, float* probability) {
  HWY_DYNAMIC_DISPATCH(probabilities)(row, min, steps_per_nat, probability);
}

void energy_disparity_row(const EnergyRow& row, const std::int32_t* winners, bool refined,
                          float* disparity_px) {
  const CandidateRange plain = row.plain_columns();
  for (int j = 0; j < row.columns; ++j) {
    const int winner = winners[j];
    if (winner == kNoWinner) {
      disparity_px[j] = std::numeric_limits<float>::quiet_NaN();
      continue;
    }
    disparity_px[j] = static_cast<float>(row.geometry.disparity_min + winner);
    const int x = row.first_column + j;
    const CandidateRange candidates = x >= plain.begin && x < plain.end
                                          ? CandidateRange{0, row.geometry.count}
                                          : row.candidates(x);
    if (!refined || winner <= candidates.begin || winner + 1 >= candidates.end) {
      continue;
    }
    const FixedEnergy* const at = row.cells + j * row.pitch + winner;
    const int curvature = at[-1] - 2 * at[0] + at[1];
    // No branch: whether the curvature is positive is hard to predict.
    const auto slope = static_cast<float>(curvature > 0 ? at[-1] - at[1] : 0);
    disparity_px[j] += slope / static_cast<float>(curvature > 0 ? 2 * curvature : 1);
  }
}

}  // namespace vantage::kernels
#endif
