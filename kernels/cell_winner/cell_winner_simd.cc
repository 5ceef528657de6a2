#include "kernels/simd-inl.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "kernels/cell_winner/cell_winner.h"
#include "kernels/cell_winner/lane_trees-inl.h"
#include "kernels/cell_winner/logarithm-inl.h"
#include "kernels/cells/exp_log-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using Tag32 = hn::Rebind<std::int32_t, TagF>;
using MaskF = decltype(hn::Eq(hn::Zero(TagF()), hn::Zero(TagF())));

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
// Position for lanes without a match: beyond every candidate, exact as float and as integer.
constexpr float kNowhere = 1 << 24;

// 0, 1, … per lane. (Highway's Iota for floats goes through memory, value by value.)
HWY_INLINE VecF cell_lane_numbers() {
  alignas(64) static constexpr float numbers[kLaneMultiple] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                               8, 9, 10, 11, 12, 13, 14, 15};
  return hn::Load(TagF(), numbers);
}

// Candidates of a column, as lane numbers.
struct LaneRange {
  VecF begin;
  VecF end;
  HWY_INLINE explicit LaneRange(CandidateRange candidates)
      : begin(hn::Set(TagF(), static_cast<float>(candidates.begin))),
        end(hn::Set(TagF(), static_cast<float>(candidates.end))) {}
};

// Tests which of the kStep lanes from `first` are candidates: all, or those in a range.
struct EveryLane {
  HWY_INLINE EveryLane(const LaneRange& /*candidates*/, int /*first*/) {}
  [[nodiscard]] HWY_INLINE VecF cells_or(VecF cells, VecF /*other*/) const { return cells; }
};
class SomeLanes {
 public:
  HWY_INLINE SomeLanes(const LaneRange& candidates, int first)
      : is_candidate_(within(candidates, first)) {}
  [[nodiscard]] HWY_INLINE VecF cells_or(VecF cells, VecF other) const {
    return hn::IfThenElse(is_candidate_, cells, other);
  }

 private:
  static HWY_INLINE MaskF within(const LaneRange& candidates, int first) {
    const VecF lane = hn::Add(cell_lane_numbers(), hn::Set(TagF(), static_cast<float>(first)));
    return hn::And(hn::Ge(lane, candidates.begin), hn::Lt(lane, candidates.end));
  }
  MaskF is_candidate_;
};

// Cells as energies: probabilities are negated, so that the minimum is the best.
template <bool kNegated>
HWY_INLINE VecF energies(const float* cells) {
  const VecF v = hn::LoadU(TagF(), cells);
  return kNegated ? hn::Neg(v) : v;
}

// Minimum per lane, and what the margin needs in addition.
template <bool kNegated, bool kMargin>
class Spread {
 public:
  HWY_INLINE Spread() : min_(hn::Set(TagF(), kInfinity)), second_(min_) {
    for (int p = 0; p < kParts; ++p) {
      sum_[p] = hn::Zero(TagF());
    }
  }
  template <class Lanes>
  HWY_INLINE void add(const float* cells, const LaneRange& range, int lane) {
    const TagF d;
#pragma GCC unroll 16
    for (int p = 0; p < kParts; ++p) {
      const Lanes counts(range, lane + p * kStep);
      const VecF v = energies<kNegated>(cells + lane + p * kStep);
      const VecF candidate = counts.cells_or(v, hn::Set(d, kInfinity));
      if constexpr (kMargin) {
        second_ = hn::Min(second_, hn::Max(min_, candidate));
        sum_[p] = hn::Add(sum_[p], counts.cells_or(v, hn::Zero(d)));
      }
      min_ = hn::Min(min_, candidate);
    }
  }
  // Stores kStep values.
  HWY_INLINE void store_min(float* min) const { hn::Store(min_, TagF(), min); }
  HWY_INLINE void store_second(float* second) const { hn::Store(second_, TagF(), second); }
  // Stores kLaneMultiple values.
  HWY_INLINE void store_sums(float* sums) const {
    for (int p = 0; p < kParts; ++p) {
      hn::Store(sum_[p], TagF(), sums + p * kStep);
    }
  }

 private:
  VecF min_;
  VecF second_;
  VecF sum_[kParts];
};

// Per lane, the first candidate whose energy is `wanted`. Does not stop early: the winner's
// position is as good as random, and a mispredicted branch costs more than all vectors.
template <bool kNegated>
class Places {
 public:
  HWY_INLINE explicit Places(VecF wanted) : wanted_(wanted), first_(hn::Set(TagF(), kNowhere)) {}
  // Lanes must be added from last to first, so that the first position remains.
  template <class Lanes>
  HWY_INLINE void add(const float* cells, const LaneRange& range, int lane) {
    const TagF d;
#pragma GCC unroll 16
    for (int p = kParts - 1; p >= 0; --p) {
      const int first = lane + p * kStep;
      const Lanes counts(range, first);
      const VecF candidate =
          counts.cells_or(energies<kNegated>(cells + first), hn::Set(d, kInfinity));
      first_ =
          hn::IfThenElse(hn::Eq(candidate, wanted_), hn::Set(d, static_cast<float>(first)), first_);
    }
  }
  HWY_INLINE void store(float* places) const {
    hn::Store(hn::Add(first_, cell_lane_numbers()), TagF(), places);
  }

 private:
  VecF wanted_;
  VecF first_;
};

// Per lane, sums of e and e·t with e = 2^−t, t = scale · (E − Emin).
class Weights {
 public:
  HWY_INLINE Weights(float min, float scale)
      : min_(hn::Set(TagF(), min)), scale_(hn::Set(TagF(), scale)) {
    for (int p = 0; p < kParts; ++p) {
      sum_[p] = weighted_[p] = hn::Zero(TagF());
    }
  }
  template <class Lanes>
  HWY_INLINE void add(const float* cells, const LaneRange& range, int lane) {
    const TagF d;
    // At this limit e is negligible beside the winner's 1.
    const VecF max = hn::Set(d, -kMinExponent);
#pragma GCC unroll 4
    for (int p = 0; p < kParts; ++p) {
      const int first = lane + p * kStep;
      const VecF above = hn::Mul(scale_, hn::Sub(hn::LoadU(d, cells + first), min_));
      const Lanes counts(range, first);
      // Also masked before the exponential: other lanes may hold NaN.
      const VecF t = counts.cells_or(hn::Min(above, max), max);
      const VecF weight = counts.cells_or(exp2_of_negative(hn::Neg(t)), hn::Zero(d));
      sum_[p] = hn::Add(sum_[p], weight);
      weighted_[p] = hn::Add(weighted_[p], hn::Mul(weight, t));
    }
  }
  // Stores kLaneMultiple values each.
  HWY_INLINE void store(float* sums, float* weighted) const {
    for (int p = 0; p < kParts; ++p) {
      hn::Store(sum_[p], TagF(), sums + p * kStep);
      hn::Store(weighted_[p], TagF(), weighted + p * kStep);
    }
  }

 private:
  VecF min_;
  VecF scale_;
  VecF sum_[kParts];
  VecF weighted_[kParts];
};

// Passes all lanes of a column to `visitor`. Where every candidate counts (kAll), only the last
// kLaneMultiple lanes can contain others.
template <bool kAll, class Visitor>
HWY_INLINE void visit_up(Visitor& visitor, const float* cells, const LaneRange& range, int lanes) {
  const int last = lanes - kLaneMultiple;
#pragma GCC unroll 4
  for (int lane = 0; lane < last; lane += kLaneMultiple) {
    if constexpr (kAll) {
      visitor.template add<EveryLane>(cells, range, lane);
    } else {
      visitor.template add<SomeLanes>(cells, range, lane);
    }
  }
  visitor.template add<SomeLanes>(cells, range, last);
}

template <bool kAll, class Visitor>
HWY_INLINE void visit_down(Visitor& visitor, const float* cells, const LaneRange& range,
                           int lanes) {
  visitor.template add<SomeLanes>(cells, range, lanes - kLaneMultiple);
#pragma GCC unroll 4
  for (int lane = lanes - 2 * kLaneMultiple; lane >= 0; lane -= kLaneMultiple) {
    if constexpr (kAll) {
      visitor.template add<EveryLane>(cells, range, lane);
    } else {
      visitor.template add<SomeLanes>(cells, range, lane);
    }
  }
}

// Stores the first `columns` values of a vector.
template <class D>
HWY_INLINE void store_first(D d, hn::VFromD<D> v, int columns, hn::TFromD<D>* output) {
  if (columns == kStep) {
    hn::StoreU(v, d, output);
    return;
  }
  HWY_ALIGN hn::TFromD<D> values[kStep];
  hn::Store(v, d, values);
  std::copy_n(values, columns, output);
}

// Columns [begin, end) of a row. kAll: every candidate counts in all of them.
template <bool kAll>
class Stretch {
 public:
  HWY_INLINE Stretch(const CellRow& row, int begin, int end)
      : row_(row),
        count_(row.geometry.count),
        lanes_(row.geometry.lanes()),
        begin_(begin),
        end_(end) {}

  template <bool kNegated, bool kMargin>
  HWY_INLINE void select(const CellWinners& outputs) const {
    const TagF d;
    HWY_ALIGN float lane_min[kStep * kStep] = {};
    HWY_ALIGN float lane_second[kMargin ? kStep * kStep : 1] = {};
    HWY_ALIGN float lane_sums[kMargin ? kStep * kLaneMultiple : 1] = {};
    HWY_ALIGN float min[kStep];
    for (int j = begin_; j < end_; j += kStep) {
      const int columns = std::min(kStep, end_ - j);
      for (int k = 0; k < columns; ++k) {
        Spread<kNegated, kMargin> spread;
        visit_up<kAll>(spread, cells(j + k), candidates(j + k), lanes_);
        spread.store_min(lane_min + k * kStep);
        if constexpr (kMargin) {
          spread.store_second(lane_second + k * kStep);
          spread.store_sums(lane_sums + k * kLaneMultiple);
        }
      }
      VecF best;
      if constexpr (kMargin) {
        const TwoSmallest two = joined_two_smallest<kStep>(lane_min, lane_second);
        best = two.min;
        store_first(d, margins(two, joined_lanes<Sum, kLaneMultiple>(lane_sums)), columns,
                    outputs.margin + j);
      } else {
        best = joined_lanes<Minimum, kStep>(lane_min);
      }
      const auto none = hn::Eq(best, hn::Set(d, kInfinity));
      if (outputs.best != nullptr) {
        store_first(d, hn::IfThenElse(none, hn::Set(d, kUnknown), kNegated ? hn::Neg(best) : best),
                    columns, outputs.best + j);
      }
      if (outputs.winners == nullptr) {
        continue;
      }
      hn::Store(best, d, min);
      for (int k = 0; k < columns; ++k) {
        Places<kNegated> places(hn::Set(d, min[k]));
        visit_down<kAll>(places, cells(j + k), candidates(j + k), lanes_);
        places.store(lane_min + k * kStep);
      }
      const VecF place = joined_lanes<Minimum, kStep>(lane_min);
      const Tag32 d32;
      store_first(d32,
                  hn::ConvertTo(d32, hn::IfThenElse(none, hn::Set(d, float{kNoWinner}), place)),
                  columns, outputs.winners + j);
    }
  }

  HWY_INLINE void entropy(const float* best, float scale, float* output) const {
    const TagF d;
    HWY_ALIGN float lane_sums[kStep * kLaneMultiple] = {};
    HWY_ALIGN float lane_weighted[kStep * kLaneMultiple] = {};
    for (int j = begin_; j < end_; j += kStep) {
      const int columns = std::min(kStep, end_ - j);
      for (int k = 0; k < columns; ++k) {
        Weights weights(best[j + k], scale * kLog2E);
        visit_up<kAll>(weights, cells(j + k), candidates(j + k), lanes_);
        weights.store(lane_sums + k * kLaneMultiple, lane_weighted + k * kLaneMultiple);
      }
      const VecF sum = joined_lanes<Sum, kLaneMultiple>(lane_sums);
      const VecF weighted = joined_lanes<Sum, kLaneMultiple>(lane_weighted);
      const VecF mean = hn::Mul(hn::Div(weighted, sum), hn::Set(d, kLn2));
      const VecF value = hn::Sub(hn::Zero(d), hn::Add(mean, log_of_normal(sum)));
      // The sum is at least 1 where there is a winner, which contributes 1.
      const auto none = hn::Lt(sum, hn::Set(d, 0.5F));
      store_first(d, hn::IfThenElse(none, hn::Set(d, kUnknown), hn::Min(value, hn::Zero(d))),
                  columns, output + j);
    }
  }

 private:
  [[nodiscard]] HWY_INLINE const float* cells(int j) const {
    return row_.cells + static_cast<std::ptrdiff_t>(j) * lanes_;
  }
  [[nodiscard]] HWY_INLINE LaneRange candidates(int j) const {
    return LaneRange(kAll ? CandidateRange{0, count_} : row_.candidates(row_.first_column + j));
  }

  static HWY_INLINE VecF margins(const TwoSmallest& two, VecF sum) {
    const TagF d;
    const VecF infinity = hn::Set(d, kInfinity);
    const VecF quotient = hn::Div(hn::Sub(two.second, two.min), sum);
    const auto defined = hn::And(hn::Lt(two.second, infinity), hn::Ne(sum, hn::Zero(d)));
    const auto none = hn::Eq(two.min, infinity);
    return hn::IfThenElse(none, hn::Set(d, kUnknown), hn::IfThenElseZero(defined, quotient));
  }

  const CellRow& row_;
  int count_;
  int lanes_;
  int begin_;
  int end_;
};

template <bool kNegated, bool kMargin>
void select_stretches(const CellRow& row, const CellWinners& outputs) {
  const auto [begin, end] = row.plain_columns();
  const int first = row.first_column;
  Stretch<false>(row, 0, begin - first).template select<kNegated, kMargin>(outputs);
  Stretch<true>(row, begin - first, end - first).template select<kNegated, kMargin>(outputs);
  Stretch<false>(row, end - first, row.columns).template select<kNegated, kMargin>(outputs);
}

void select_cell_winners_row_simd(const CellRow& row, const CellWinners& outputs) {
  if (outputs.margin != nullptr) {
    select_stretches<false, true>(row, outputs);
  } else if (row.probabilities) {
    select_stretches<true, false>(row, outputs);
  } else {
    select_stretches<false, false>(row, outputs);
  }
}

void cell_entropy_row_simd(const CellRow& row, const float* best, float scale, float* entropy) {
  const auto [begin, end] = row.plain_columns();
  const int first = row.first_column;
  Stretch<false>(row, 0, begin - first).entropy(best, scale, entropy);
  Stretch<true>(row, begin - first, end - first).entropy(best, scale, entropy);
  Stretch<false>(row, end - first, row.columns).entropy(best, scale, entropy);
}

void probability_energy_row_simd(const float* probability, int columns, float* energy) {
  const hn::ScalableTag<double> d64;
  const hn::Rebind<float, decltype(d64)> d32;
  constexpr int step = static_cast<int>(hn::MaxLanes(d64));
  const auto energies_of = [&](const float* p) HWY_ATTR {
    const auto v = hn::LoadU(d32, p);
    const auto zero = hn::Zero(d32);
    const auto logarithm = natural_logarithm(d64, hn::PromoteTo(d64, v));
    const auto positive = hn::Sub(zero, hn::DemoteTo(d32, logarithm));
    const auto other =
        hn::IfThenElse(hn::Eq(v, zero), hn::Set(d32, kInfinity), hn::Set(d32, kUnknown));
    return hn::IfThenElse(hn::Gt(v, zero), positive, other);
  };
  int j = 0;
  for (; j + step <= columns; j += step) {
    hn::StoreU(energies_of(probability + j), d32, energy + j);
  }
  if (j < columns) {
    HWY_ALIGN float last[step] = {};
    std::copy_n(probability + j, columns - j, last);
    hn::StoreU(energies_of(last), d32, last);
    std::copy_n(last, columns - j, energy + j);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(select_cell_winners_row_simd);
HWY_EXPORT(cell_entropy_row_simd);
HWY_EXPORT(probability_energy_row_simd);

void select_cell_winners_row(const CellRow& row, const CellWinners& outputs) {
  HWY_DYNAMIC_DISPATCH(select_cell_winners_row_simd)(row, outputs);
}

void cell_entropy_row(const CellRow& row, const float* best, float scale, float* entropy) {
  HWY_DYNAMIC_DISPATCH(cell_entropy_row_simd)(row, best, scale, entropy);
}

void probability_energy_row(const float* probability, int columns, float* energy) {
  HWY_DYNAMIC_DISPATCH(probability_energy_row_simd)(probability, columns, energy);
}

}  // namespace vantage::kernels
#endif
