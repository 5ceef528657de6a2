#include "kernels/simd-inl.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "kernels/cells/byte_cells-inl.h"
#include "kernels/cells/exp_log-inl.h"
#include "kernels/cells/exp_log.h"
#include "kernels/cells/lane_sums-inl.h"
#include "kernels/compact_likelihoods/compact_likelihoods.h"
#include "kernels/compact_likelihoods/reduced_sums-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using IntTag = hn::RebindToSigned<FloatTag>;
using ByteTag = hn::Rebind<std::uint8_t, FloatTag>;

// Rounds step numbers ≥ 0 and stores them as bytes.
HWY_INLINE void store_steps(FloatVec steps, std::uint8_t* bytes) {
  const FloatVec max = hn::Set(FloatTag(), static_cast<float>(kMaxCompact));
  hn::StoreU(hn::DemoteTo(ByteTag(), hn::NearestInt(hn::Min(steps, max))), ByteTag(), bytes);
}

HWY_INLINE FloatVec load_steps(const std::uint8_t* bytes) {
  return hn::ConvertTo(FloatTag(), hn::PromoteTo(IntTag(), hn::LoadU(ByteTag(), bytes)));
}

void reduce_likelihoods(const BlockRow<float>& row, float weight, float* work,
                        std::uint8_t* energies) {
  const FloatTag df;
  const FloatVec min = hn::Set(df, kMinReducedLikelihood);
  const FloatVec steps = hn::Set(df, weight / kEnergyStep);
  for (int b = 0; b < row.blocks(); ++b, energies += row.lanes) {
    const auto load = [&](const float* cells, std::ptrdiff_t at)
                          HWY_ATTR { return hn::Max(hn::LoadU(df, cells + at), min); };
    LaneBlock16 max;
    max.fill(hn::Set(df, std::numeric_limits<float>::lowest()));
    for (int lane = 0; lane < row.lanes; lane += kLaneMultiple) {
      for (int part = 0; part < kParts; ++part) {
        const int first = lane + part * kFloatLanes;
        const std::ptrdiff_t left = row.left(b) + first;
        const std::ptrdiff_t right = row.right(b) + first;
        const FloatVec product = hn::Mul(hn::Mul(load(row.upper, left), load(row.upper, right)),
                                         hn::Mul(load(row.lower, left), load(row.lower, right)));
        const FloatVec log = log_of_normal(product);
        max.part[part] = hn::Max(max.part[part], log);
        hn::StoreU(log, df, work + first);
      }
    }
    const FloatVec top = max_lanes(max);
    for (int lane = 0; lane < row.lanes; lane += kFloatLanes) {
      store_steps(hn::Mul(hn::Sub(top, hn::LoadU(df, work + lane)), steps), energies + lane);
    }
  }
}

// 16-bit sums of byte cells, even and odd lanes separately; neither leaves its 128-bit block.
template <class D8>
struct BlockSums {
  VecOf<Tag16<D8> > even;
  VecOf<Tag16<D8> > odd;
};

template <class D8>
HWY_INLINE BlockSums<D8> block_sums(D8 d, const BlockRow<std::uint8_t>& row, int block, int lane) {
  const Tag16<D8> d16;
  const auto even_lanes = hn::Set(d16, 0xFF);
  const auto load = [&](const std::uint8_t* cells, std::ptrdiff_t column)
                        HWY_ATTR { return hn::BitCast(d16, hn::LoadU(d, cells + column + lane)); };
  const auto a = load(row.upper, row.left(block));
  const auto b = load(row.upper, row.right(block));
  const auto c = load(row.lower, row.left(block));
  const auto e = load(row.lower, row.right(block));
  return {hn::Add(hn::Add(hn::And(a, even_lanes), hn::And(b, even_lanes)),
                  hn::Add(hn::And(c, even_lanes), hn::And(e, even_lanes))),
          hn::Add(hn::Add(hn::ShiftRight<8>(a), hn::ShiftRight<8>(b)),
                  hn::Add(hn::ShiftRight<8>(c), hn::ShiftRight<8>(e)))};
}

// Writes the sums of one block to `work`, in vectors of D8's size while whole vectors fit. `lane`
// becomes the first remaining lane, `min` the minimum per lane.
template <class D8>
HWY_INLINE void sum_block(D8 d, const BlockRow<std::uint8_t>& row, int block, std::uint16_t* work,
                          int& lane, VecOf<SumTag>& min) {
  const Tag16<D8> d16;
  const int step = static_cast<int>(hn::Lanes(d));
  if (lane + step > row.lanes) {
    return;
  }
  auto of_lanes = hn::Set(d16, std::numeric_limits<std::uint16_t>::max());
  for (; lane + step <= row.lanes; lane += step) {
    const BlockSums<D8> sums = block_sums(d, row, block, lane);
    hn::StoreU(sums.even, d16, work + lane);
    hn::StoreU(sums.odd, d16, work + lane + step / 2);
    of_lanes = hn::Min(of_lanes, hn::Min(sums.even, sums.odd));
  }
  min = hn::Min(min, fold_min(d16, of_lanes));
}

void reduce_compact_energies(const BlockRow<std::uint8_t>& row, float weight, std::uint16_t* work,
                             std::uint8_t* energies) {
  const hn::ScalableTag<std::uint8_t> widest;
  const hn::CappedTag<std::uint8_t, 32> middle;
  const hn::CappedTag<std::uint8_t, kLaneMultiple> narrow;
  const auto units = static_cast<std::int16_t>(std::lround(weight * kCompactWeightUnits));
  for (int b = 0; b < row.blocks(); ++b, energies += row.lanes) {
    auto min = hn::Set(SumTag(), std::numeric_limits<std::uint16_t>::max());
    int lane = 0;
    sum_block(widest, row, b, work, lane, min);
    sum_block(middle, row, b, work, lane, min);
    sum_block(narrow, row, b, work, lane, min);
    const std::uint16_t bottom = hn::GetLane(hn::MinOfLanes(SumTag(), min));
    weigh_sums(work, row.lanes, bottom, units, energies);
  }
}

// Vectors of 16 lanes, whose neighbours are in the vectors before and after.
void allow_slant(std::uint8_t* energies, int columns, int lanes, std::uint8_t penalty) {
  const hn::CappedTag<std::uint8_t, kLaneMultiple> d;
  const auto cost = hn::Set(d, penalty);
  const auto outside = hn::Set(d, static_cast<std::uint8_t>(kMaxCompact));
  for (int x = 0; x < columns; ++x, energies += lanes) {
    auto before = outside;
    auto own = hn::LoadU(d, energies);
    for (int lane = 0; lane < lanes; lane += kLaneMultiple) {
      const bool is_last = lane + kLaneMultiple == lanes;
      const auto after = is_last ? outside : hn::LoadU(d, energies + lane + kLaneMultiple);
      const auto beside = hn::Min(hn::CombineShiftRightBytes<kLaneMultiple - 1>(d, own, before),
                                  hn::CombineShiftRightBytes<1>(d, after, own));
      hn::StoreU(hn::Min(own, hn::SaturatedAdd(beside, cost)), d, energies + lane);
      before = own;
      own = after;
    }
  }
}

// 2^(step · exponent_of_step) for the candidates of each column, 0 in the other lanes.
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
  const FloatVec min = hn::Set(df, kMinCompactProbability);
  const FloatVec steps = hn::Set(df, -kLog2E / kProbabilityExponentStep);
  for (int k = 0; k < cells; k += kFloatLanes) {
    const FloatVec log = log_of_normal(hn::Max(hn::LoadU(df, probabilities + k), min));
    store_steps(hn::Max(hn::Mul(log, steps), hn::Zero(df)), compact + k);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(reduce_likelihoods);
HWY_EXPORT(reduce_compact_energies);
HWY_EXPORT(allow_slant);
HWY_EXPORT(likelihoods);
HWY_EXPORT(probabilities);
HWY_EXPORT(compact_probabilities);

void reduce_likelihoods_row(const BlockRow<float>& row, float weight, float* work,
                            std::uint8_t* energies) {
  HWY_DYNAMIC_DISPATCH(reduce_likelihoods)(row, weight, work, energies);
}
void reduce_compact_energies_row(const BlockRow<std::uint8_t>& row, float weight,
                                 std::uint16_t* work, std::uint8_t* energies) {
  HWY_DYNAMIC_DISPATCH(reduce_compact_energies)(row, weight, work, energies);
}
void allow_slant_row(std::uint8_t* energies, int columns, int lanes, std::uint8_t penalty) {
  HWY_DYNAMIC_DISPATCH(allow_slant)(energies, columns, lanes, penalty);
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
