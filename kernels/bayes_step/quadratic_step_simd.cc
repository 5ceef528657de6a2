#include "kernels/simd-inl.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "kernels/bayes_step/quadratic_step.h"
#include "kernels/cells/exp_log-inl.h"
#include "kernels/cells/lane_sums-inl.h"
#include "kernels/cells/star_columns-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// Logarithm of what is no candidate: below everything that is one.
constexpr float kNoCandidate = -1e30F;
// Terms this far below the largest one are less than its rounding error.
constexpr float kNegligibleBits = 25;
// Smoothed logarithms exceed 0 by that of the number of candidates at most.
constexpr float kMaxLogarithm = 13;

// log₂ of positive floats.
HWY_INLINE FloatVec binary_logarithm(FloatVec value) {
  const FloatTag df;
  const FloatVec normal = hn::Max(value, hn::Set(df, std::numeric_limits<float>::min()));
  return hn::Mul(log_of_normal(normal), hn::Set(df, kLog2E));
}

// Smoothing along one direction.
class QuadraticSmoothing {
 public:
  explicit QuadraticSmoothing(const QuadraticStepRow& row)
      : curvature_(row.curvature), largest_term_(row.largest_term) {}

  // at(k): logarithms k candidates away, |k| ≤ reach.
  template <class At>
  [[nodiscard]] HWY_INLINE FloatVec of(At at, int reach) const {
    const FloatVec own = at(0);
    FloatVec largest = own;
    for (int k = 1; k <= reach && can_add(largest, k, 0); ++k) {
      largest = hn::Max(largest, hn::Sub(hn::Max(at(-k), at(k)), rise(k)));
    }
    return largest_term_ ? largest : logarithm_of_sum(at, reach, largest);
  }

 private:
  [[nodiscard]] HWY_INLINE FloatVec rise(int k) const {
    return hn::Set(FloatTag(), curvature_ * static_cast<float>(k) * static_cast<float>(k));
  }
  // Whether terms k or more candidates away can be within `bits` of the largest one in some lane.
  [[nodiscard]] HWY_INLINE bool can_add(FloatVec largest, int k, float bits) const {
    const FloatVec top = hn::Sub(hn::Set(FloatTag(), kMaxLogarithm + bits), rise(k));
    return !hn::AllTrue(FloatTag(), hn::Gt(largest, top));
  }

  template <class At>
  [[nodiscard]] HWY_INLINE FloatVec logarithm_of_sum(At at, int reach, FloatVec largest) const {
    const FloatTag df;
    const auto counts = [&](FloatVec exponent)
                            HWY_ATTR { return hn::Gt(exponent, hn::Set(df, -kNegligibleBits)); };
    const auto power = [&](FloatVec exponent) HWY_ATTR {
      return hn::IfThenElseZero(counts(exponent), exp2_of_negative(exponent));
    };
    FloatVec sum = power(hn::Sub(at(0), largest));
    for (int k = 1; k <= reach && can_add(largest, k, kNegligibleBits); ++k) {
      const FloatVec offset = hn::Add(largest, rise(k));
      const FloatVec below = hn::Sub(at(-k), offset);
      const FloatVec above = hn::Sub(at(k), offset);
      if (!hn::AllFalse(df, counts(hn::Max(below, above)))) {
        sum = hn::Add(sum, hn::Add(power(below), power(above)));
      }
    }
    return hn::Add(largest, binary_logarithm(sum));
  }

  float curvature_;
  bool largest_term_;
};

// Unfused, so that every instruction set gives the same bits.
template <bool kStar, bool kWeighted>
HWY_INLINE FloatVec star_sum(const QuadraticStepRow& row, const StarColumns<float>& at, int lane) {
  const FloatTag df;
  if constexpr (!kStar) {
    return hn::Zero(df);
  } else {
    const auto part = [&](const float* cells, const float* weight) HWY_ATTR {
      const FloatVec cell = hn::Load(df, cells + lane);
      return kWeighted ? hn::Mul(hn::Set(df, *weight), cell) : cell;
    };
    const StarWeights& weights = row.weights;
    const FloatVec vertical =
        hn::Add(part(at.up, weights.above + at.x), part(at.down, weights.below + at.x));
    const FloatVec horizontal =
        hn::Add(part(at.left, weights.beside + at.x), part(at.right, weights.beside + at.x + 1));
    return hn::Add(hn::Add(vertical, horizontal), hn::Load(df, at.centre + lane));
  }
}

template <bool kStar, bool kWeighted>
class QuadraticColumns {
 public:
  explicit QuadraticColumns(const QuadraticStepRow& row)
      : row_(row), lanes_(row.star.lanes), smoothing_(row), logarithms_(row.work + lanes_) {
    std::fill_n(row.work, 3 * lanes_, kNoCandidate);
  }

  void run() const {
    each_column(row_, [&](const StarColumns<float>& at, float* output) HWY_ATTR {
      make_logarithms(at);
      if (!row_.smooths) {
        store_probabilities(output);
      } else if (row_.plane.is_given()) {
        store_smoothed_plane(output);
      } else {
        for (int lane = 0; lane < lanes_; lane += kFloatLanes) {
          const float* const here = logarithms_ + lane;
          const FloatVec smoothed = smoothing_.of(
              [here](int k) HWY_ATTR { return hn::LoadU(FloatTag(), here + k); }, row_.count - 1);
          store_state(smoothed, lane, output);
        }
      }
    });
  }

 private:
  [[nodiscard]] HWY_INLINE auto candidates_at(int lane) const {
    const int left = std::clamp(row_.count - lane, 0, kFloatLanes);
    return hn::FirstN(FloatTag(), static_cast<std::size_t>(left));
  }

  HWY_INLINE void store_state(FloatVec smoothed, int lane, float* output) const {
    const FloatTag df;
    const FloatVec state = hn::Mul(smoothed, hn::Set(df, row_.mu));
    hn::Store(hn::IfThenElseZero(candidates_at(lane), state), df, output + lane);
  }

  HWY_INLINE void make_logarithms(const StarColumns<float>& at) const {
    const FloatTag df;
    LaneBlock16 max;
    max.fill(hn::Set(df, kNoCandidate));
    for (int lane = 0; lane < lanes_; lane += kLaneMultiple) {
      for (int part = 0; part < kParts; ++part) {
        const int first = lane + part * kFloatLanes;
        const FloatVec sum = hn::Add(binary_logarithm(hn::Load(df, at.source + first)),
                                     star_sum<kStar, kWeighted>(row_, at, first));
        const FloatVec logarithm =
            hn::IfThenElse(candidates_at(first), sum, hn::Set(df, kNoCandidate));
        hn::Store(logarithm, df, logarithms_ + first);
        max.part[part] = hn::Max(max.part[part], logarithm);
      }
    }
    const FloatVec largest = max_lanes(max);
    const FloatVec lowest = hn::Set(df, kLowestLogarithm);
    for (int lane = 0; lane < lanes_; lane += kFloatLanes) {
      const FloatVec shifted = hn::Sub(hn::Load(df, logarithms_ + lane), largest);
      hn::Store(
          hn::IfThenElse(candidates_at(lane), hn::Max(shifted, lowest), hn::Set(df, kNoCandidate)),
          df, logarithms_ + lane);
    }
  }

  HWY_INLINE void store_probabilities(float* output) const {
    const FloatTag df;
    LaneBlock16 sums;
    sums.fill(hn::Zero(df));
    for (int lane = 0; lane < lanes_; lane += kLaneMultiple) {
      for (int part = 0; part < kParts; ++part) {
        const int first = lane + part * kFloatLanes;
        const FloatVec exponent = hn::Load(df, logarithms_ + first);
        const FloatVec p = hn::IfThenElseZero(hn::Gt(exponent, hn::Set(df, kMinExponent)),
                                              exp2_of_negative(exponent));
        hn::Store(p, df, output + first);
        sums.part[part] = hn::Add(sums.part[part], p);
      }
    }
    const FloatVec total = sum_lanes(sums);
    for (int lane = 0; lane < lanes_; lane += kFloatLanes) {
      hn::Store(hn::Div(hn::Load(df, output + lane), total), df, output + lane);
    }
  }

  // Smooths a column of a two-dimensional search horizontally, then vertically.
  void store_smoothed_plane(float* output) const {
    const FloatTag df;
    const CandidatePlane& plane = row_.plane;
    const int row_lanes = plane.row_lanes();
    float* const run = row_.work + 3 * lanes_ + row_lanes;  // a row of candidates
    float* const across = run + 2 * row_lanes;
    float* const smoothed = across + plane.rows * row_lanes;
    std::fill_n(run - row_lanes, 3 * row_lanes, kNoCandidate);
    for (int r = 0; r < plane.rows; ++r) {
      std::copy_n(logarithms_ + r * plane.row_candidates, plane.row_candidates, run);
      for (int lane = 0; lane < row_lanes; lane += kFloatLanes) {
        const float* const here = run + lane;
        const FloatVec result =
            smoothing_.of([here](int k) HWY_ATTR { return hn::LoadU(FloatTag(), here + k); },
                          plane.row_candidates - 1);
        hn::StoreU(result, df, across + r * row_lanes + lane);
      }
    }
    for (int r = 0; r < plane.rows; ++r) {
      for (int lane = 0; lane < row_lanes; lane += kFloatLanes) {
        const FloatVec result = smoothing_.of(
            [&](int k) HWY_ATTR {
              return r + k >= 0 && r + k < plane.rows
                         ? hn::LoadU(FloatTag(), across + (r + k) * row_lanes + lane)
                         : hn::Set(FloatTag(), kNoCandidate);
            },
            plane.rows - 1);
        // Values stored after a run's candidates are overwritten by the next run.
        hn::StoreU(result, df, smoothed + r * plane.row_candidates + lane);
      }
    }
    for (int lane = 0; lane < lanes_; lane += kFloatLanes) {
      store_state(hn::LoadU(df, smoothed + lane), lane, output);
    }
  }

  const QuadraticStepRow& row_;
  int lanes_;
  QuadraticSmoothing smoothing_;
  float* logarithms_;
};

void quadratic_start_row_simd(const QuadraticStepRow& row) {
  QuadraticColumns<false, false>(row).run();
}

void quadratic_step_row_simd(const QuadraticStepRow& row) {
  if (row.weights.are_given()) {
    QuadraticColumns<true, true>(row).run();
  } else {
    QuadraticColumns<true, false>(row).run();
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(quadratic_start_row_simd);
HWY_EXPORT(quadratic_step_row_simd);

void quadratic_start_row(const QuadraticStepRow& row) {
  HWY_DYNAMIC_DISPATCH(quadratic_start_row_simd)(row);
}
void quadratic_step_row(const QuadraticStepRow& row) {
  HWY_DYNAMIC_DISPATCH(quadratic_step_row_simd)(row);
}

// Scalar reference.

namespace {

double squared_distance(const QuadraticStepRow& row, int i, int j) {
  if (!row.plane.is_given()) {
    return std::pow(i - j, 2);
  }
  const int in_row = row.plane.row_candidates;
  return std::pow(i % in_row - j % in_row, 2) + std::pow(i / in_row - j / in_row, 2);
}

// logarithm(j): log₂ p.
template <class Logarithm>
double smoothed_logarithm(const QuadraticStepRow& row, int i, Logarithm logarithm) {
  const auto term = [&](int j) {
    return logarithm(j) - row.curvature * squared_distance(row, i, j);
  };
  double largest = term(i);
  for (int j = 0; j < row.count; ++j) {
    largest = std::max(largest, term(j));
  }
  if (row.largest_term) {
    return largest;
  }
  double sum = 0;
  for (int j = 0; j < row.count; ++j) {
    sum += std::exp2(term(j) - largest);
  }
  return largest + std::log2(sum);
}

// sum(x, i): of the star.
template <class Sum>
void quadratic_columns(const QuadraticStepRow& row, Sum sum) {
  for (int x = 0; x < row.star.columns; ++x) {
    const auto unshifted = [&](int i) {
      const double likelihood =
          std::max(row.star.source[x * row.source_pitch + i], std::numeric_limits<float>::min());
      return std::log2(likelihood) + sum(x, i);
    };
    double max = unshifted(0);
    for (int i = 1; i < row.count; ++i) {
      max = std::max(max, unshifted(i));
    }
    const auto logarithm = [&](int i) {
      return std::max(unshifted(i) - max, double{kLowestLogarithm});
    };
    double total = 0;
    for (int i = 0; i < row.count; ++i) {
      total += std::exp2(logarithm(i));
    }
    float* const output = row.output + x * row.output_pitch;
    std::fill_n(output, row.star.lanes, 0.0F);
    for (int i = 0; i < row.count; ++i) {
      output[i] = static_cast<float>(row.smooths ? row.mu * smoothed_logarithm(row, i, logarithm)
                                                 : std::exp2(logarithm(i)) / total);
    }
  }
}

}  // namespace

void quadratic_start_row_ref(const QuadraticStepRow& row) {
  quadratic_columns(row, [](int, int) { return 0.0; });
}

void quadratic_step_row_ref(const QuadraticStepRow& row) {
  const StarRow& star = row.star;
  const auto weight = [&row](const float* weights, int x) {
    return row.weights.are_given() ? double{weights[x]} : 1.0;
  };
  quadratic_columns(row, [&](int x, int i) {
    return star.centre[x * star.pitch + i] + weight(row.weights.beside, x) * star.left_of(x)[i] +
           weight(row.weights.beside, x + 1) * star.right_of(x)[i] +
           weight(row.weights.above, x) * star.up[x * star.up_pitch + i] +
           weight(row.weights.below, x) * star.down[x * star.down_pitch + i];
  });
}

}  // namespace vantage::kernels
#endif
