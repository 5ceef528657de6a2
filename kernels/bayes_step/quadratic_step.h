#pragma once

#include <cstddef>

#include "kernels/candidates.h"
#include "kernels/star_row.h"

namespace vantage::kernels {

/// One row of Bayesian diffusion with a quadratic prior, ρP(k) = k²/2σP² (6.18). Nothing limits
/// what a jump of disparities costs, so probabilities leave the range of floats and all is done in
/// their logarithms:
///
///     log₂ p(i) = log₂ p0(i) + weighted sum of μ · log₂ pS(i) over the star, minus its maximum
///     log₂ pS(i) = log₂ Σ_j 2^(log₂ p(j) − curvature · (i − j)²), or the largest term alone
///
/// Every candidate can be the nearest that is likely, so the sum has all of them; terms that are
/// less than the rounding error of the largest one are skipped. Results are identical on every
/// instruction set.
struct QuadraticStepRow {
  /// Cells are μ · log₂ pS; neutral columns hold 0. `star.source` holds the likelihoods p0 up to a
  /// factor per column.
  StarRow star;
  float curvature = 1;        ///< log₂(e) / 2σP², σP in candidates; ≥ 0, at most 1e20
  bool largest_term = false;  ///< the largest term in place of the sum
  /// true: the output is μ · log₂ pS, the input of the next iteration; false: normalised p.
  bool smooths = true;
  float mu = 0.5F;
  StarWeights weights = {};  ///< absent: all are 1
  int count = 0;             ///< candidates: lanes [0, count); the output is 0 in other lanes
  float* output = nullptr;   ///< must not overlap the input
  /// Floats between columns of star.source and of the output; ≥ star.lanes, multiples of
  /// kLaneMultiple.
  std::ptrdiff_t source_pitch = 0;
  std::ptrdiff_t output_pitch = 0;
  /// For a two-dimensional search: (i − j)² is then the squared length of an offset.
  CandidatePlane plane = {};
  /// quadratic_work_floats() floats, 64-byte aligned; contents may be arbitrary.
  float* work = nullptr;
};

/// Logarithms (base 2) of probabilities stop here.
inline constexpr float kLowestLogarithm = -1e9F;

/// A column with a margin as wide on either side. For a two-dimensional search also a row of
/// candidates with margins as wide, all rows smoothed along themselves, and the smoothed column.
inline int quadratic_work_floats(int lanes, const CandidatePlane& plane = {}) {
  return 3 * lanes + (plane.is_given() ? (3 + plane.rows) * plane.row_lanes() + lanes +
                                             kLaneMultiple + plane.row_lanes()
                                       : 0);
}

/// Before the first iteration: p = p0. Reads only star.source, columns and lanes.
void quadratic_start_row(const QuadraticStepRow& row);
void quadratic_step_row(const QuadraticStepRow& row);

/// Scalar reference, in double.
void quadratic_start_row_ref(const QuadraticStepRow& row);
void quadratic_step_row_ref(const QuadraticStepRow& row);

}  // namespace vantage::kernels
