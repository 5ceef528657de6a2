#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "kernels/candidates.h"
#include "kernels/cells/exp_log.h"
#include "kernels/star_row.h"

namespace vantage::kernels {

/// Smoothing by the prior along a cell column (6.35), up to a factor that cancels in the
/// normalisation: pS(i) = Σ_k tap[|k|] · p(i + k) + floor · Σ p, with p = 0 outside the range of
/// candidates. The floor is the contamination εP, which is the same for all offsets.
struct PriorKernel {
  const float* taps = nullptr;  ///< tap[0] … tap[radius]
  int radius = 0;
  float floor = 0;  ///< > 0
};

/// What an iteration stores in its output cells.
enum class BayesState {
  kSmoothed,     ///< pS: input of iterations with μ = ½
  kLogSmoothed,  ///< μ · log₂ pS: input of iterations with any other μ
  kProbability,  ///< normalised p, after the last iteration
};

/// One row of Bayesian diffusion (6.32)–(6.37). `star.source` holds the likelihoods p0 up to a
/// factor per column, and 0 in lanes that are not candidates.
struct BayesRow {
  StarRow star;
  PriorKernel prior;
  BayesState state = BayesState::kSmoothed;
  float mu = 0.5F;           ///< for kLogSmoothed
  StarWeights weights = {};  ///< for bayes_general_row; absent: all weights are 1
  int count = 0;             ///< candidates: lanes [0, count)
  float* output = nullptr;   ///< must not overlap the input
  /// Floats between columns of star.source and of the output; ≥ star.lanes, multiples of
  /// kLaneMultiple.
  std::ptrdiff_t source_pitch = 0;
  std::ptrdiff_t output_pitch = 0;
  /// For a two-dimensional search. The prior's taps then multiply, so the prior is a contaminated
  /// Gaussian of the offset's length.
  CandidatePlane plane = {};
  /// bayes_work_floats() floats, 64-byte aligned; contents may be arbitrary.
  float* work = nullptr;
};

/// Columns whose probabilities are in work memory at a time: some are summed while others are
/// normalised.
inline int bayes_work_columns(int lanes) {
  constexpr int kMaxFloats = 1024;
  return std::clamp(kMaxFloats / lanes, 1, 8);
}

/// Number of zeros that smoothing needs on each side of a column.
inline int bayes_work_margin(int prior_radius) {
  return (prior_radius + kLaneMultiple - 1) / kLaneMultiple * kLaneMultiple;
}

/// `plane`: for a two-dimensional search.
inline int bayes_work_floats(int lanes, int prior_radius, const CandidatePlane& plane = {}) {
  return bayes_work_columns(lanes) * (lanes + 2 * bayes_work_margin(prior_radius)) +
         (plane.is_given() ? plane.work_cells(bayes_work_margin(prior_radius)) : 0);
}

/// Before the first iteration: normalises p0 and stores its state. Reads only star.source, columns
/// and lanes.
void bayes_start_row(const BayesRow& row);

/// μ = ½ needs no exponentials or logarithms: p ∝ p0 · sqrt(product of pS over the star). Cells are
/// pS; neutral columns hold 1. Relative error of p below 1e-6, provided that the product of five
/// floors is a normal float.
void bayes_half_row(const BayesRow& row);

/// Whether 2^(sum over the star) could underflow in all lanes of a column. If so, the column's
/// maximum sum must be subtracted first. For any μ.
inline bool bayes_scales_sums(float mu, float floor) {
  return 5.0F * mu * std::log2(floor) <= 0.8F * kMinExponent;
}

/// Any μ: p ∝ p0 · 2^(weighted sum of μ · log₂ pS over the star). Cells are μ · log₂ pS; neutral
/// columns hold 0. Relative error of p below 1e-5.
void bayes_general_row(const BayesRow& row);

/// Scalar reference, in double.
void bayes_start_row_ref(const BayesRow& row);
void bayes_half_row_ref(const BayesRow& row);
void bayes_general_row_ref(const BayesRow& row);

}  // namespace vantage::kernels
