#include "kernels/simd-inl.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "kernels/candidates.h"
#include "kernels/cells/exp_log-inl.h"
#include "kernels/cells/lane_sums-inl.h"
#include "kernels/local_stopping_step/local_stopping_step.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// Masks the candidates in the last, possibly partial block of a column.
class CandidateLanes {
 public:
  explicit CandidateLanes(int count) : whole_(count / kLaneMultiple * kLaneMultiple) {
    for (int i = 0; i < kLaneMultiple; ++i) {
      is_candidate_[i] = whole_ + i < count ? 1.0F : 0.0F;
    }
    has_part_ = whole_ < count;
  }
  [[nodiscard]] HWY_INLINE int whole() const { return whole_; }
  [[nodiscard]] HWY_INLINE bool has_part() const { return has_part_; }
  [[nodiscard]] HWY_INLINE auto mask(int part) const {
    const FloatTag df;
    return hn::Gt(hn::Load(df, is_candidate_ + part * kFloatLanes), hn::Zero(df));
  }

 private:
  alignas(64) float is_candidate_[kLaneMultiple];
  int whole_;
  bool has_part_;
};

// Smallest and second smallest element and sum of a column, per lane.
struct Margin {
  LaneBlock16 min;
  LaneBlock16 second;
  LaneBlock16 sum;

  HWY_INLINE Margin() {
    const FloatTag df;
    min.fill(hn::Set(df, std::numeric_limits<float>::infinity()));
    second = min;
    sum.fill(hn::Zero(df));
  }
  HWY_INLINE void add(int part, FloatVec energy, FloatVec summand) {
    second.part[part] = hn::Min(second.part[part], hn::Max(min.part[part], energy));
    min.part[part] = hn::Min(min.part[part], energy);
    sum.part[part] = hn::Add(sum.part[part], summand);
  }
  HWY_INLINE void add(int part, FloatVec energy) { add(part, energy, energy); }
  template <class Mask>
  HWY_INLINE void add_where(Mask mask, int part, FloatVec energy) {
    const FloatTag df;
    add(part, hn::IfThenElse(mask, energy, hn::Set(df, std::numeric_limits<float>::infinity())),
        hn::IfThenElseZero(mask, energy));
  }
  // The margin, in every lane.
  [[nodiscard]] HWY_INLINE FloatVec value(int count) const {
    const FloatTag df;
    if (count < 2) {
      return hn::Zero(df);
    }
    const FloatVec total = sum_lanes(sum);
    const FloatVec best = min_lanes(min);
    const FloatVec next = second_of_lanes(best);
    const FloatVec margin = hn::Div(hn::Sub(next, best), total);
    return hn::IfThenElse(hn::Eq(total, hn::Zero(df)), hn::Zero(df), margin);
  }

 private:
  // Second smallest element overall: the minimum of the lanes' second smallest and of the lanes'
  // smallest without one occurrence of the best.
  [[nodiscard]] HWY_INLINE FloatVec second_of_lanes(FloatVec best) const {
    const FloatTag df;
    LaneBlock16 others = min;
    LaneBlock16 ties;
    for (int part = 0; part < kParts; ++part) {
      const auto is_best = hn::Eq(min.part[part], best);
      others.part[part] = hn::IfThenElse(
          is_best, hn::Set(df, std::numeric_limits<float>::infinity()), min.part[part]);
      ties.part[part] = hn::IfThenElseZero(is_best, hn::Set(df, 1.0F));
      others.part[part] = hn::Min(others.part[part], second.part[part]);
    }
    const auto tied = hn::Gt(sum_lanes(ties), hn::Set(df, 1.5F));
    return hn::IfThenElse(tied, best, min_lanes(others));
  }
};

// Diffusion step (6.7) of one column. kWeighted: neighbours have weights.
template <bool kWeighted>
struct ColumnStep {
  const float* centre;
  const float* left;
  const float* right;
  const float* up;
  const float* down;
  FloatVec own;
  FloatVec step;
  StarSteps steps;  // weighted

  HWY_INLINE void take_weights(const LocalStoppingRow& row, int x) {
    if constexpr (kWeighted) {
      steps = StarSteps::of(row.weights, row.step, x);
      own = hn::Set(FloatTag(), 1.0F - steps.sum());
    }
  }

  HWY_INLINE FloatVec energy(int lane) const {
    const FloatTag df;
    const auto load = [lane, df](const float* cells)
                          HWY_ATTR { return hn::Load(df, cells + lane); };
    if constexpr (kWeighted) {
      const auto part = [&](float weight, const float* cells)
                            HWY_ATTR { return hn::Mul(hn::Set(df, weight), load(cells)); };
      const FloatVec neighbours = hn::Add(hn::Add(part(steps.left, left), part(steps.right, right)),
                                          hn::Add(part(steps.up, up), part(steps.down, down)));
      return hn::Add(hn::Mul(own, load(centre)), neighbours);
    } else {
      const FloatVec neighbours =
          hn::Add(hn::Add(load(left), load(right)), hn::Add(load(up), load(down)));
      return hn::Add(hn::Mul(own, load(centre)), hn::Mul(step, neighbours));
    }
  }
};

// Calls visit(part, cells) for each full vector of candidates and visit_where(mask, part, cells)
// for those of a partial block.
template <class Cells, class Visit, class VisitWhere>
HWY_INLINE void each_candidate(const CandidateLanes& lanes, Cells cells, Visit visit,
                               VisitWhere visit_where) {
  int lane = 0;
  for (; lane < lanes.whole(); lane += kLaneMultiple) {
    for (int part = 0; part < kParts; ++part) {
      visit(part, cells(lane + part * kFloatLanes));
    }
  }
  if (lanes.has_part()) {
    for (int part = 0; part < kParts; ++part) {
      visit_where(lanes.mask(part), part, cells(lane + part * kFloatLanes));
    }
  }
}

HWY_INLINE FloatVec winner_margin(const CandidateLanes& lanes, int count, const float* cells) {
  const FloatTag df;
  Margin margin;
  each_candidate(
      lanes, [&](int lane) HWY_ATTR { return hn::Load(df, cells + lane); },
      [&](int part, FloatVec energy) HWY_ATTR { margin.add(part, energy); },
      [&](auto mask, int part, FloatVec energy) HWY_ATTR { margin.add_where(mask, part, energy); });
  return margin.value(count);
}

// log(1 + u), u ≥ 0, with a small relative error for small u, too.
HWY_INLINE FloatVec log_of_one_plus(FloatVec u) {
  const FloatTag df;
  const FloatVec one = hn::Set(df, 1.0F);
  const FloatVec sum = hn::Add(one, u);
  const FloatVec kept = hn::Sub(sum, one);  // u as rounding has left it
  const FloatVec logarithm = hn::Mul(log_of_normal(sum), hn::Div(u, kept));
  return hn::IfThenElse(hn::Eq(kept, hn::Zero(df)), u, logarithm);
}

HWY_INLINE FloatVec negative_entropy(const CandidateLanes& lanes, float scale, const float* cells) {
  const FloatTag df;
  const auto load = [&](int lane) HWY_ATTR { return hn::Load(df, cells + lane); };
  const FloatVec infinity = hn::Set(df, std::numeric_limits<float>::infinity());
  LaneBlock16 min;
  min.fill(infinity);
  each_candidate(
      lanes, load,
      [&](int part, FloatVec energy) HWY_ATTR { min.part[part] = hn::Min(min.part[part], energy); },
      [&](auto mask, int part, FloatVec energy) HWY_ATTR {
        min.part[part] = hn::Min(min.part[part], hn::IfThenElse(mask, energy, infinity));
      });
  const FloatVec best = min_lanes(min);
  const FloatVec scales = hn::Set(df, scale * kLog2E);
  // Sums of weights below 1 and of those that are 1: the winner's, which must not hide the others.
  LaneBlock16 below;
  LaneBlock16 ones;
  LaneBlock16 moment;
  below.fill(hn::Zero(df));
  ones = moment = below;
  const FloatVec one = hn::Set(df, 1.0F);
  const auto add = [&](int part, FloatVec exponent, FloatVec weight) HWY_ATTR {
    const auto is_one = hn::Eq(weight, one);
    below.part[part] = hn::Add(below.part[part], hn::IfThenZeroElse(is_one, weight));
    ones.part[part] = hn::Add(ones.part[part], hn::IfThenElseZero(is_one, one));
    moment.part[part] = hn::Add(moment.part[part], hn::Mul(weight, exponent));
  };
  // Beyond the minimum exponent the weight is negligible; the clamp keeps the product finite.
  const auto exponent_of = [&](FloatVec energy) HWY_ATTR {
    return hn::Min(hn::Mul(scales, hn::Sub(energy, best)), hn::Set(df, -kMinExponent));
  };
  each_candidate(
      lanes, load,
      [&](int part, FloatVec energy) HWY_ATTR {
        const FloatVec exponent = exponent_of(energy);
        add(part, exponent, exp2_of_negative(hn::Neg(exponent)));
      },
      [&](auto mask, int part, FloatVec energy) HWY_ATTR {
        const FloatVec exponent = exponent_of(energy);
        add(part, exponent, hn::IfThenElseZero(mask, exp2_of_negative(hn::Neg(exponent))));
      });
  const FloatVec others = hn::Add(hn::Sub(sum_lanes(ones), one), sum_lanes(below));
  const FloatVec mean_exponent =
      hn::Mul(hn::Div(sum_lanes(moment), hn::Add(one, others)), hn::Set(df, kLn2));
  return hn::Neg(hn::Add(mean_exponent, log_of_one_plus(others)));
}

// Writes the step of one column to `output` and returns the certainty of the result.
template <class Step>
HWY_INLINE FloatVec step_with_margin(const Step& column, const CandidateLanes& lanes, int count,
                                     int all_lanes, float* output) {
  const FloatTag df;
  Margin margin;
  int lane = 0;
  for (; lane < lanes.whole(); lane += kLaneMultiple) {
    for (int part = 0; part < kParts; ++part) {
      const int first = lane + part * kFloatLanes;
      const FloatVec energy = column.energy(first);
      hn::Store(energy, df, output + first);
      margin.add(part, energy);
    }
  }
  for (; lane < all_lanes; lane += kLaneMultiple) {
    for (int part = 0; part < kParts; ++part) {
      const int first = lane + part * kFloatLanes;
      const FloatVec energy = column.energy(first);
      hn::Store(energy, df, output + first);
      margin.add_where(lanes.mask(part), part, energy);
    }
  }
  return margin.value(count);
}

template <class Step>
HWY_INLINE FloatVec step_with_entropy(const Step& column, const CandidateLanes& lanes, float scale,
                                      int all_lanes, float* output) {
  const FloatTag df;
  for (int lane = 0; lane < all_lanes; lane += kFloatLanes) {
    hn::Store(column.energy(lane), df, output + lane);
  }
  return negative_entropy(lanes, scale, output);
}

template <bool kWeighted>
HWY_INLINE void local_stopping_columns(const LocalStoppingRow& row) {
  const FloatTag df;
  const StarRow& star = row.star;
  const int all_lanes = star.lanes;
  const CandidateLanes lanes(row.count);
  const bool is_margin = row.measure == CertaintyMeasure::kMargin;
  ColumnStep<kWeighted> column{star.centre,
                               star.left_of_first,
                               nullptr,
                               star.up,
                               star.down,
                               hn::Set(df, 1.0F - 4.0F * row.step),
                               hn::Set(df, row.step),
                               {}};
  float* output = row.output;
  for (int x = 0; x < star.columns; ++x) {
    column.right = x + 1 < star.columns ? column.centre + star.pitch : star.right_of_last;
    column.take_weights(row, x);
    FloatVec before;
    if (star.pitch > all_lanes) {
      before = hn::Set(df, column.centre[all_lanes]);
    } else {
      before = is_margin ? winner_margin(lanes, row.count, column.centre)
                         : negative_entropy(lanes, row.scale, column.centre);
    }
    FloatVec after = is_margin ? step_with_margin(column, lanes, row.count, all_lanes, output)
                               : step_with_entropy(column, lanes, row.scale, all_lanes, output);
    if (hn::GetLane(before) > hn::GetLane(after)) {
      std::copy_n(column.centre, all_lanes, output);
      after = before;
    }
    if (row.output_pitch > all_lanes) {
      for (int i = 0; i < kCertaintyFloats; i += kFloatLanes) {
        hn::Store(after, df, output + all_lanes + i);
      }
    }
    column.left = column.centre;
    column.centre += star.pitch;
    column.up += star.up_pitch;
    column.down += star.down_pitch;
    output += row.output_pitch;
  }
}

void local_stopping_row_simd(const LocalStoppingRow& row) {
  if (row.weights.are_given()) {
    local_stopping_columns<true>(row);
  } else {
    local_stopping_columns<false>(row);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(local_stopping_row_simd);

void local_stopping_row(const LocalStoppingRow& row) {
  HWY_DYNAMIC_DISPATCH(local_stopping_row_simd)(row);
}

}  // namespace vantage::kernels
#endif
