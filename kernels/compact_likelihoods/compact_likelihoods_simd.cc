#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/compact_likelihoods/compact_likelihoods_simd.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, so that it is compiled once per target.
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "kernels/cells/exp_log-inl.h"
#include "kernels/cells/lane_sums-inl.h"
#include "kernels/compact_likelihoods/compact_likelihoods.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using IntTag = hn::RebindToSigned<FloatTag>;
using ByteTag = hn::Rebind<std::uint8_t, FloatTag>;

// Rounds numbers of steps ≥ 0 and stores them as bytes.
HWY_INLINE void store_steps(FloatVec steps, std::uint8_t* bytes) {
  const FloatVec most = hn::Set(FloatTag(), static_cast<float>(kMostCompact));
  hn::StoreU(hn::DemoteTo(ByteTag(), hn::NearestInt(hn::Min(steps, most))), ByteTag(), bytes);
}

HWY_INLINE FloatVec load_steps(const std::uint8_t* bytes) {
  return hn::ConvertTo(FloatTag(), hn::PromoteTo(IntTag(), hn::LoadU(ByteTag(), bytes)));
}

void reduce_likelihoods(const BlockRow<float>& row, float weight, float* work,
                        std::uint8_t* energies) {
  const FloatTag df;
  const FloatVec least = hn::Set(df, kLeastReducedLikelihood);
  const FloatVec steps = hn::Set(df, weight / kEnergyStep);
  for (int b = 0; b < row.blocks(); ++b, energies += row.lanes) {
    const auto load = [&](const float* cells, std::ptrdiff_t at)
                          HWY_ATTR { return hn::Max(hn::LoadU(df, cells + at), least); };
    LaneBlock16 most;
    most.fill(hn::Set(df, std::numeric_limits<float>::lowest()));
    for (int lane = 0; lane < row.lanes; lane += kLaneMultiple) {
      for (int part = 0; part < kParts; ++part) {
        const int first = lane + part * kFloatLanes;
        const std::ptrdiff_t left = row.left(b) + first;
        const std::ptrdiff_t right = row.right(b) + first;
        const FloatVec product = hn::Mul(hn::Mul(load(row.upper, left), load(row.upper, right)),
                                         hn::Mul(load(row.lower, left), load(row.lower, right)));
        const FloatVec log = log_of_normal(product);
        most.part[part] = hn::Max(most.part[part], log);
        hn::StoreU(log, df, work + first);
      }
    }
    const FloatVec top = max_lanes(most);
    for (int lane = 0; lane < row.lanes; lane += kFloatLanes) {
      store_steps(hn::Mul(hn::Sub(top, hn::LoadU(df, work + lane)), steps), energies + lane);
    }
  }
}

void reduce_compact_energies(const BlockRow<std::uint8_t>& row, float weight,
                             std::uint8_t* energies) {
  const hn::CappedTag<std::uint16_t, kLaneMultiple> d16;
  const hn::RebindToSigned<decltype(d16)> di16;
  const hn::Rebind<std::uint8_t, decltype(d16)> d8;
  const int step = static_cast<int>(hn::Lanes(d16));
  const auto units =
      hn::Set(di16, static_cast<std::int16_t>(std::lround(weight * kCompactWeightUnits)));
  for (int b = 0; b < row.blocks(); ++b, energies += row.lanes) {
    const auto sum = [&](int lane) HWY_ATTR {
      const auto load = [&](const std::uint8_t* cells, std::ptrdiff_t column) HWY_ATTR {
        return hn::PromoteTo(d16, hn::LoadU(d8, cells + column + lane));
      };
      return hn::Add(hn::Add(load(row.upper, row.left(b)), load(row.upper, row.right(b))),
                     hn::Add(load(row.lower, row.left(b)), load(row.lower, row.right(b))));
    };
    auto least = hn::Set(d16, std::numeric_limits<std::uint16_t>::max());
    for (int lane = 0; lane < row.lanes; lane += step) {
      least = hn::Min(least, sum(lane));
    }
    HWY_ALIGN std::uint16_t of_lane[kLaneMultiple];
    hn::Store(least, d16, of_lane);
    const auto bottom = hn::Set(d16, *std::min_element(of_lane, of_lane + step));
    for (int lane = 0; lane < row.lanes; lane += step) {
      // At most 4 · 255, doubled: the product's fixed point is at 2^15. Bytes saturate.
      const auto above = hn::BitCast(di16, hn::ShiftLeft<1>(hn::Sub(sum(lane), bottom)));
      hn::StoreU(hn::DemoteTo(d8, hn::MulFixedPoint15(above, units)), d8, energies + lane);
    }
  }
}

// 2^(step · exponent_of_step) of the candidates of each column, 0 in the other lanes.
HWY_INLINE void powers(const CompactRow& row, float exponent_of_step, float* output) {
  const FloatTag df;
  const FloatVec scale = hn::Set(df, exponent_of_step);
  const std::uint8_t* cells = row.cells;
  for (int x = 0; x < row.columns; ++x, cells += row.lanes, output += row.lanes) {
    int lane = 0;
    for (; lane + kFloatLanes <= row.count; lane += kFloatLanes) {
      hn::StoreU(exp2_of_negative(hn::Mul(load_steps(cells + lane), scale)), df, output + lane);
    }
    for (; lane < row.lanes; lane += kFloatLanes) {
      const auto is_candidate =
          hn::FirstN(df, static_cast<std::size_t>(std::max(0, row.count - lane)));
      const FloatVec power = exp2_of_negative(hn::Mul(load_steps(cells + lane), scale));
      hn::StoreU(hn::IfThenElseZero(is_candidate, power), df, output + lane);
    }
  }
}

void likelihoods(const CompactRow& row, float* output) {
  powers(row, -kEnergyStep * kLog2E, output);
}

void probabilities(const CompactRow& row, float* output) {
  powers(row, -kProbabilityExponentStep, output);
}

void compact_probabilities(const float* probabilities, int cells, std::uint8_t* compact) {
  const FloatTag df;
  const FloatVec least = hn::Set(df, kLeastCompactProbability);
  const FloatVec steps = hn::Set(df, -kLog2E / kProbabilityExponentStep);
  for (int k = 0; k < cells; k += kFloatLanes) {
    const FloatVec log = log_of_normal(hn::Max(hn::LoadU(df, probabilities + k), least));
    store_steps(hn::Max(hn::Mul(log, steps), hn::Zero(df)), compact + k);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(reduce_likelihoods);
HWY_EXPORT(reduce_compact_energies);
HWY_EXPORT(likelihoods);
HWY_EXPORT(probabilities);
HWY_EXPORT(compact_probabilities);

void reduce_likelihoods_row(const BlockRow<float>& row, float weight, float* work,
                            std::uint8_t* energies) {
  HWY_DYNAMIC_DISPATCH(reduce_likelihoods)(row, weight, work, energies);
}
void reduce_compact_energies_row(const BlockRow<std::uint8_t>& row, float weight,
                                 std::uint8_t* energies) {
  HWY_DYNAMIC_DISPATCH(reduce_compact_energies)(row, weight, energies);
}
void likelihoods_of_compact_row(const CompactRow& row, float* output) {
  HWY_DYNAMIC_DISPATCH(likelihoods)(row, output);
}
void probabilities_of_compact_row(const CompactRow& row, float* output) {
  HWY_DYNAMIC_DISPATCH(probabilities)(row, output);
}
void compact_probabilities_row(const float* input, int cells, std::uint8_t* compact) {
  HWY_DYNAMIC_DISPATCH(compact_probabilities)(input, cells, compact);
}

}  // namespace vantage::kernels
#endif
