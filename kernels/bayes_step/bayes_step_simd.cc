#include "kernels/simd-inl.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "kernels/bayes_step/bayes_step.h"
#include "kernels/bayes_step/powers-inl.h"
#include "kernels/candidates.h"
#include "kernels/cells/lane_sums-inl.h"
#include "kernels/cells/star_columns-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// p0 · sqrt(product of the star), up to a factor common to all lanes.
HWY_INLINE FloatVec half_weight(const StarColumns<float>& at, int lane) {
  const FloatTag df;
  const auto load = [&](const float* cells) HWY_ATTR { return hn::Load(df, cells + lane); };
  const FloatVec product =
      hn::Mul(hn::Mul(hn::Mul(load(at.up), load(at.down)), hn::Mul(load(at.left), load(at.right))),
              load(at.centre));
  // One Newton step on the estimate y of 1/sqrt(x): 2 sqrt(x) = (x·y) (3 − (x·y)·y). This takes 5
  // cycles per vector; a square root takes 10 to 12.
  FloatVec estimate = hn::ApproximateReciprocalSqrt(product);
#if HWY_ARCH_ARM
  // It has 8 bits, on x86 12 or 14: one step more.
  const FloatVec three_halves = hn::Set(df, 1.5F);
  const FloatVec half_product = hn::Mul(product, hn::Set(df, 0.5F));
  estimate =
      hn::Mul(estimate, hn::NegMulAdd(hn::Mul(half_product, estimate), estimate, three_halves));
#endif
  const FloatVec root = hn::Mul(product, estimate);
  const FloatVec correction = hn::NegMulAdd(root, estimate, hn::Set(df, 3.0F));
  return hn::Mul(hn::Mul(load(at.source), root), correction);
}

// Columns of kBlocks · 16 lanes whose prior has one tap: everything stays in registers.
template <int kBlocks>
HWY_INLINE void half_column_in_registers(const StarColumns<float>& at, float scale, float floor,
                                         float* output) {
  const FloatTag df;
  constexpr int kVectors = kBlocks * kParts;
  FloatVec p[kVectors];
  LaneBlock16 sums;
#pragma GCC unroll 16
  for (int v = 0; v < kVectors; ++v) {
    p[v] = half_weight(at, v * kFloatLanes);
    sums.part[v % kParts] = v < kParts ? p[v] : hn::Add(sums.part[v % kParts], p[v]);
  }
  const FloatVec factor = hn::Div(hn::Set(df, scale), sum_lanes(sums));
  const FloatVec lowest = hn::Set(df, floor);
#pragma GCC unroll 16
  for (int v = 0; v < kVectors; ++v) {
    hn::Store(hn::MulAdd(p[v], factor, lowest), df, output + v * kFloatLanes);
  }
}

template <int kBlocks>
HWY_INLINE void half_row_in_registers(const BayesRow& row) {
  const bool smooth = row.state != BayesState::kProbability;
  const float scale = smooth ? row.prior.taps[0] : 1.0F;
  const float floor = smooth ? row.prior.floor : 0.0F;
  each_column(row, [&](const StarColumns<float>& at, float* output)
                       HWY_ATTR { half_column_in_registers<kBlocks>(at, scale, floor, output); });
}

// Unnormalised probabilities of a few columns in memory, with zeros on both sides of each column,
// where there are no candidates. First all columns are computed, then all are normalised; one by
// one, each column would wait for the sum over its lanes.
//
// Columns have kBlocks · kLaneMultiple lanes, so that loops are unrolled: with few lanes the loop
// overhead would equal the cost of the body. kBlocks = 0: any number of lanes.
template <int kBlocks>
class WorkColumns {
 public:
  explicit WorkColumns(const BayesRow& row)
      : row_(row),
        columns_(bayes_work_columns(row.star.lanes)),
        margin_(bayes_work_margin(row.prior.radius)),
        pitch_(row.star.lanes + 2 * margin_),
        logarithm_(row.mu) {
    for (int j = 0; j < std::min(columns_, row.star.columns); ++j) {
      clear_margin(p(j) - margin_);
      clear_margin(p(j) + row.star.lanes);
    }
  }

  // Computes p = weight(columns)(lane) for all columns of the row and stores the row's state.
  template <class Weight>
  HWY_INLINE void run(Weight weight) const {
    FloatVec normalise[kMaxColumns];
    float* block_output = row_.output;
    int filled = 0;
    each_column(row_, [&](const StarColumns<float>& at, float* output) HWY_ATTR {
      normalise[filled] = make(at, weight, p(filled));
      ++filled;
      if (filled == columns_ || output == last_output()) {
        for (int j = 0; j < filled; ++j) {
          finish(p(j), normalise[j], block_output);
          block_output += row_.output_pitch;
        }
        filled = 0;
      }
    });
  }

 private:
  static constexpr int kMaxColumns = 8;  // maximum of bayes_work_columns()

  void clear_margin(float* margin) const {
    for (int lane = 0; lane < margin_; lane += kFloatLanes) {
      hn::Store(hn::Zero(FloatTag()), FloatTag(), margin + lane);
    }
  }
  [[nodiscard]] float* p(int column) const { return row_.work + column * pitch_ + margin_; }
  [[nodiscard]] const float* last_output() const {
    return row_.output + (row_.star.columns - 1) * row_.output_pitch;
  }

  [[nodiscard]] HWY_INLINE int lanes() const {
    return kBlocks > 0 ? kBlocks * kLaneMultiple : row_.star.lanes;
  }

  // Returns the normalising factor of the column.
  template <class Weight>
  HWY_INLINE FloatVec make(const StarColumns<float>& at, Weight weight, float* p) const {
    const FloatTag df;
    const auto weight_of_lanes = weight(at);
    LaneBlock16 sums;
    sums.fill(hn::Zero(df));
    for (int lane = 0; lane < lanes(); lane += kLaneMultiple) {
      for (int part = 0; part < kParts; ++part) {
        const int first = lane + part * kFloatLanes;
        const FloatVec value = weight_of_lanes(first);
        hn::Store(value, df, p + first);
        sums.part[part] = hn::Add(sums.part[part], value);
      }
    }
    return hn::Div(hn::Set(df, 1.0F), sum_lanes(sums));
  }

  HWY_INLINE void finish(const float* p, FloatVec normalise, float* output) const {
    const FloatTag df;
    if (row_.plane.is_given() && row_.state != BayesState::kProbability) {
      return smooth_plane(p, normalise, output);
    }
    if (row_.state == BayesState::kProbability) {
      for (int lane = 0; lane < lanes(); lane += kFloatLanes) {
        hn::Store(hn::Mul(hn::Load(df, p + lane), normalise), df, output + lane);
      }
      return;
    }
    if (row_.state == BayesState::kSmoothed) {
      smooth(p, normalise, output, [](FloatVec smoothed) HWY_ATTR { return smoothed; });
    } else {
      smooth(p, normalise, output,
             [this](FloatVec smoothed) HWY_ATTR { return logarithm_.of(smoothed); });
    }
  }

  template <class State>
  HWY_INLINE void smooth(const float* p, FloatVec normalise, float* output, State state) const {
    switch (row_.prior.radius) {
      case 0:
        return smooth_with<0>(p, normalise, output, state);
      case 1:
        return smooth_with<1>(p, normalise, output, state);
      case 2:
        return smooth_with<2>(p, normalise, output, state);
      default:
        return smooth_with<-1>(p, normalise, output, state);
    }
  }

  // kRadius: radius of the prior; −1 for any.
  template <int kRadius, class State>
  HWY_INLINE void smooth_with(const float* p, FloatVec normalise, float* output,
                              State state) const {
    const FloatTag df;
    const float* const taps = row_.prior.taps;
    const int radius = kRadius >= 0 ? kRadius : row_.prior.radius;
    const FloatVec floor = hn::Set(df, row_.prior.floor);
    for (int lane = 0; lane < lanes(); lane += kFloatLanes) {
      FloatVec sum = hn::Mul(hn::Load(df, p + lane), hn::Set(df, taps[0]));
      for (int k = 1; k <= radius; ++k) {
        const FloatVec both = hn::Add(hn::LoadU(df, p + lane - k), hn::LoadU(df, p + lane + k));
        sum = hn::MulAdd(both, hn::Set(df, taps[k]), sum);
      }
      hn::Store(state(hn::MulAdd(sum, normalise, floor)), df, output + lane);
    }
  }

  // States of a column of a two-dimensional search: smoothed horizontally, then vertically.
  HWY_NOINLINE void smooth_plane(const float* p, FloatVec normalise, float* output) const {
    const FloatTag df;
    const CandidatePlane& plane = row_.plane;
    const float* const taps = row_.prior.taps;
    const int row_lanes = plane.row_lanes();
    const int spread_pitch = row_lanes + margin_;
    float* const spread = row_.work + columns_ * pitch_ + margin_;
    float* const across = spread + plane.rows * spread_pitch;
    float* const states = across + plane.rows * row_lanes;
    std::fill(spread - margin_, across, 0.0F);
    for (int r = 0; r < plane.rows; ++r) {
      std::copy_n(p + r * plane.row_candidates, plane.row_candidates, spread + r * spread_pitch);
      for (int lane = 0; lane < row_lanes; lane += kFloatLanes) {
        const float* const at = spread + r * spread_pitch + lane;
        FloatVec sum = hn::Mul(hn::LoadU(df, at), hn::Set(df, taps[0]));
        for (int k = 1; k <= row_.prior.radius; ++k) {
          const FloatVec both = hn::Add(hn::LoadU(df, at - k), hn::LoadU(df, at + k));
          sum = hn::MulAdd(both, hn::Set(df, taps[k]), sum);
        }
        hn::StoreU(sum, df, across + r * row_lanes + lane);
      }
    }
    const FloatVec floor = hn::Set(df, row_.prior.floor);
    const auto state = [&](FloatVec smoothed) HWY_ATTR {
      return row_.state == BayesState::kSmoothed ? smoothed : logarithm_.of(smoothed);
    };
    for (int r = 0; r < plane.rows; ++r) {
      for (int lane = 0; lane < row_lanes; lane += kFloatLanes) {
        FloatVec sum = hn::LoadU(df, across + r * row_lanes + lane);
        for (int k = 1; k <= row_.prior.radius; ++k) {
          const FloatVec tap = hn::Set(df, taps[k] / taps[0]);
          for (const int beside : {r - k, r + k}) {
            if (beside >= 0 && beside < plane.rows) {
              sum = hn::MulAdd(hn::LoadU(df, across + beside * row_lanes + lane), tap, sum);
            }
          }
        }
        // Values stored after a run's candidates are overwritten by the next run.
        hn::StoreU(state(hn::MulAdd(sum, normalise, floor)), df,
                   states + r * plane.row_candidates + lane);
      }
    }
    std::fill(states + plane.count(), states + row_.star.lanes, hn::GetLane(state(floor)));
    std::copy_n(states, row_.star.lanes, output);
  }

  const BayesRow& row_;
  int columns_;
  int margin_;
  int pitch_;
  ScaledLogarithm logarithm_;
};

template <class Weight>
HWY_INLINE void run_columns(const BayesRow& row, Weight weight) {
  switch (row.star.lanes) {
    case kLaneMultiple:
      return WorkColumns<1>(row).run(weight);
    case 2 * kLaneMultiple:
      return WorkColumns<2>(row).run(weight);
    case 3 * kLaneMultiple:
      return WorkColumns<3>(row).run(weight);
    default:
      return WorkColumns<0>(row).run(weight);
  }
}

void bayes_start_row_simd(const BayesRow& row) {
  run_columns(row, [](const StarColumns<float>& at) HWY_ATTR {
    return [&at](int lane) HWY_ATTR { return hn::Load(FloatTag(), at.source + lane); };
  });
}

void bayes_half_row_simd(const BayesRow& row) {
  // On AVX-512, columns of up to 64 lanes fit into registers.
  if (row.state == BayesState::kProbability ||
      (row.state == BayesState::kSmoothed && row.prior.radius == 0)) {
    switch (row.star.lanes / kLaneMultiple) {
      case 1:
        return half_row_in_registers<1>(row);
      case 2:
        return half_row_in_registers<2>(row);
      case 3:
        return half_row_in_registers<3>(row);
      case 4:
        return half_row_in_registers<4>(row);
      case 5:
        return half_row_in_registers<5>(row);
      case 6:
        return half_row_in_registers<6>(row);
      case 8:
        return half_row_in_registers<8>(row);
      default:
        break;
    }
  }
  run_columns(row, [](const StarColumns<float>& at) HWY_ATTR {
    return [&at](int lane) HWY_ATTR { return half_weight(at, lane); };
  });
}

// Sum of a star's states.
struct StarSum {
  StarSum(const BayesRow& /*row*/, const StarColumns<float>& columns) : at(columns) {}
  HWY_INLINE FloatVec of(int lane) const {
    const FloatTag df;
    const auto load = [&](const float* cells) HWY_ATTR { return hn::Load(df, cells + lane); };
    return hn::Add(
        hn::Add(hn::Add(load(at.up), load(at.down)), hn::Add(load(at.left), load(at.right))),
        load(at.centre));
  }
  const StarColumns<float>& at;
};

// Same with a weight per neighbour.
struct WeightedStarSum {
  WeightedStarSum(const BayesRow& row, const StarColumns<float>& columns)
      : at(columns),
        left(row.weights.beside[columns.x]),
        right(row.weights.beside[columns.x + 1]),
        up(row.weights.above[columns.x]),
        down(row.weights.below[columns.x]) {}
  HWY_INLINE FloatVec of(int lane) const {
    const FloatTag df;
    const auto load = [&](const float* cells) HWY_ATTR { return hn::Load(df, cells + lane); };
    const FloatVec vertical =
        hn::MulAdd(hn::Set(df, up), load(at.up), hn::Mul(hn::Set(df, down), load(at.down)));
    const FloatVec horizontal = hn::MulAdd(hn::Set(df, left), load(at.left), load(at.centre));
    return hn::Add(vertical, hn::MulAdd(hn::Set(df, right), load(at.right), horizontal));
  }
  const StarColumns<float>& at;
  float left;
  float right;
  float up;
  float down;
};

// Maximum sum of a column, in every lane. Lanes that are not candidates have the state of p = 0; no
// candidate is below it.
template <class Sum>
HWY_INLINE FloatVec largest_sum(const Sum& star, int lanes) {
  const FloatTag df;
  LaneBlock16 max;
  max.fill(hn::Set(df, std::numeric_limits<float>::lowest()));
  for (int lane = 0; lane < lanes; lane += kLaneMultiple) {
    for (int part = 0; part < kParts; ++part) {
      max.part[part] = hn::Max(max.part[part], star.of(lane + part * kFloatLanes));
    }
  }
  return max_lanes(max);
}

// kScaled: shifts the maximum sum to 0, so that at least one lane does not underflow.
template <class Sum, bool kScaled>
HWY_INLINE void general_columns(const BayesRow& row) {
  run_columns(row, [&row](const StarColumns<float>& at) HWY_ATTR {
    // Constructed in place: copies would go through memory, stored and loaded in different sizes.
    return [star = Sum(row, at), largest = kScaled ? largest_sum(Sum(row, at), row.star.lanes)
                                                   : hn::Zero(FloatTag())](int lane) HWY_ATTR {
      FloatVec exponent = star.of(lane);
      if constexpr (kScaled) {
        exponent = hn::Sub(exponent, largest);
      }
      return hn::Mul(hn::Load(FloatTag(), star.at.source + lane), power_of_two<kScaled>(exponent));
    };
  });
}

template <class Sum>
HWY_INLINE void general_row(const BayesRow& row) {
  if (bayes_scales_sums(row.mu, row.prior.floor)) {
    general_columns<Sum, true>(row);
  } else {
    general_columns<Sum, false>(row);
  }
}

void bayes_general_row_simd(const BayesRow& row) {
  if (row.weights.are_given()) {
    general_row<WeightedStarSum>(row);
  } else {
    general_row<StarSum>(row);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(bayes_start_row_simd);
HWY_EXPORT(bayes_half_row_simd);
HWY_EXPORT(bayes_general_row_simd);

void bayes_start_row(const BayesRow& row) { HWY_DYNAMIC_DISPATCH(bayes_start_row_simd)(row); }
void bayes_half_row(const BayesRow& row) { HWY_DYNAMIC_DISPATCH(bayes_half_row_simd)(row); }
void bayes_general_row(const BayesRow& row) { HWY_DYNAMIC_DISPATCH(bayes_general_row_simd)(row); }

}  // namespace vantage::kernels
#endif
