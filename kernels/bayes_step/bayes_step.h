#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "kernels/candidates.h"
#include "kernels/cells/exp_log.h"
#include "kernels/star_row.h"

namespace vantage::kernels {

/// The prior's smoothing along a cell column (6.35), up to a factor that cancels when
/// probabilities are normalised: pS(i) = Σ_k tap[|k|] · p(i + k) + floor · Σ p, p being 0 outside
/// the range of candidates. The floor stands for the contamination εP, which all offsets share.
struct PriorKernel {
  const float* taps = nullptr;  ///< tap[0] … tap[radius]
  int radius = 0;
  float floor = 0;  ///< > 0
};

/// What an iteration leaves in its output cells.
enum class BayesState {
  kSmoothed,     ///< pS: what iterations with μ = ½ look at
  kLogSmoothed,  ///< μ · log₂ pS: what iterations with any other μ look at
  kProbability,  ///< p itself, normalised, after the last iteration
};

/// How much the neighbours of each column count, from 0 to 1, beside the column itself with 1:
/// diffusion mediated by intensity edges (7.3). Weights of neighbours that are neutral columns are
/// any finite numbers.
struct StarWeights {
  const float* beside = nullptr;  ///< [x], x in [0, columns]: of columns x − 1 and x for each other
  const float* above = nullptr;  ///< [x], x in [0, columns): of the column above x
  const float* below = nullptr;  ///< [x]: of the column below x

  [[nodiscard]] bool are_given() const { return beside != nullptr; }
};

/// One row of Bayesian diffusion (6.32)–(6.37). `star.source` holds the likelihoods p0 up to a
/// factor per column; lanes that are no candidates hold 0 there.
struct BayesRow {
  StarRow star;
  PriorKernel prior;
  BayesState state = BayesState::kSmoothed;
  float mu = 0.5F;           ///< for kLogSmoothed
  StarWeights weights = {};  ///< for bayes_general_row; not given: all count 1
  int count = 0;             ///< candidates: lanes [0, count)
  float* output = nullptr;   ///< not an input
  /// Floats from column to column of star.source and of the output, ≥ star.lanes, multiples of
  /// kLaneMultiple.
  std::ptrdiff_t source_pitch = 0;
  std::ptrdiff_t output_pitch = 0;
  /// Where candidates are displacements in two dimensions: the prior's taps then multiply, which
  /// makes it a contaminated Gaussian of the length of an offset.
  CandidatePlane plane = {};
  /// bayes_work_floats() floats, 64-byte aligned; any contents.
  float* work = nullptr;
};

/// Columns whose probabilities are in work memory at a time: while some are summed up, others are
/// normalised.
inline int bayes_work_columns(int lanes) {
  constexpr int kMostFloats = 1024;
  return std::clamp(kMostFloats / lanes, 1, 8);
}

/// Zeros that the smoothing needs on either side of a column.
inline int bayes_work_margin(int prior_radius) {
  return (prior_radius + kLaneMultiple - 1) / kLaneMultiple * kLaneMultiple;
}

/// `plane`: of a search in two dimensions.
inline int bayes_work_floats(int lanes, int prior_radius, const CandidatePlane& plane = {}) {
  return bayes_work_columns(lanes) * (lanes + 2 * bayes_work_margin(prior_radius)) +
         (plane.is_given() ? plane.work_cells(bayes_work_margin(prior_radius)) : 0);
}

/// Before the first iteration: p = p0 normalised, and its state. Only star.source, columns and
/// lanes are looked at.
void bayes_start_row(const BayesRow& row);

/// μ = ½, without exponentials and logarithms: p ∝ p0 · sqrt(product of pS over the star). Cells
/// are pS; neutral columns hold 1. Relative error of p below 1e-6, as long as the product of five
/// floors is a normal float.
void bayes_half_row(const BayesRow& row);

/// Whether powers of two of sums over the star could all underflow in a column, so that its largest
/// sum has to be found and subtracted first: for any μ.
inline bool bayes_scales_sums(float mu, float floor) {
  return 5.0F * mu * std::log2(floor) <= 0.8F * kLeastExponent;
}

/// Any μ: p ∝ p0 · 2^(sum of μ · log₂ pS over the star, neighbours weighted). Cells are
/// μ · log₂ pS; neutral columns hold 0. Relative error of p below 1e-5.
void bayes_general_row(const BayesRow& row);

/// The same, plainly, in double arithmetic.
void bayes_start_row_ref(const BayesRow& row);
void bayes_half_row_ref(const BayesRow& row);
void bayes_general_row_ref(const BayesRow& row);

}  // namespace vantage::kernels
