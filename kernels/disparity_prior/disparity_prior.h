#pragma once

#include <algorithm>
#include <limits>

#include "kernels/candidates.h"
#include "kernels/cells/exp_log.h"

namespace vantage::kernels {

// Pulls pixels towards expected disparities. Both forms are the same function of k = d − d_prior, a
// parabola with a floor: the energy of a Gaussian truncated two pixels away. Beyond that a prior no
// longer distinguishes candidates. As a likelihood its floor is e⁻¹ = 0.37 at weight 1. That is
// weaker than a pixel's own costs (whose contamination is εM = 0.1), so a surface that is gone does
// not stay in the map against the images. A parabola does not move the vertex of another parabola
// at the same place, so sub-pixel positions are unchanged. Identical on every instruction set.

/// The prior's energy grows as (k / kPriorReachPx)² up to 1.
inline constexpr float kPriorReachPx = 2.0F;
/// −log of the floor of the prior's likelihood.
inline constexpr float kPriorDepth = 1.0F;

/// Cells of one row, `lanes` floats per column, and the disparities to pull their columns towards.
struct DisparityPriorRow {
  /// One disparity per column. Columns whose disparity is NaN or outside those of the candidates
  /// are unchanged.
  const float* prior_px = nullptr;
  int columns = 0;
  int lanes = 0;          ///< a multiple of kLaneMultiple
  int count = 0;          ///< candidates: lanes [0, count)
  int disparity_min = 0;  ///< in steps, as in CandidateGeometry
  int steps_per_px = 1;
  /// Likelihoods only: the candidate in lane 0, if the cells hold a subset of candidates.
  int first_candidate = 0;
  float weight = 1;  ///< ≥ 0
  /// Energies only: upper limit of a column's contrast, see energies_with_prior_row().
  float max_contrast = std::numeric_limits<float>::infinity();

  [[nodiscard]] bool has_prior(int column) const {
    const float offset = candidate(column);
    return offset >= 0 && offset <= static_cast<float>(count - 1);
  }
  /// Position of the prior disparity among the candidates.
  [[nodiscard]] float candidate(int column) const {
    return prior_px[column] * static_cast<float>(steps_per_px) - static_cast<float>(disparity_min);
  }
  /// Inverse of the number of candidates over which the energy grows to 1.
  [[nodiscard]] float inverse_reach() const {
    return 1 / (kPriorReachPx * static_cast<float>(steps_per_px));
  }
};

/// Energies: E += weight · s · min(k²/4, 1). s is the mean of the column's candidates minus their
/// minimum, at most max_contrast; it gives the prior the unit and contrast of the costs. All lanes
/// are changed; non-candidate lanes must be finite and count neither for the mean nor for the
/// minimum.
void energies_with_prior_row(const DisparityPriorRow& row, float* cells);

/// Exponent (base 2) of the prior's likelihood at two pixels and beyond. Clamped where products
/// with the smallest likelihoods would no longer be normal floats.
inline float prior_exponent_scale(float weight) {
  constexpr float kMin = -20.0F;
  return std::max(-kPriorDepth * kLog2E * weight, kMin);
}

/// Likelihoods: p *= exp(−w · min(k²/4, 1)), w = weight, at most 20 log 2.
void likelihoods_with_prior_row(const DisparityPriorRow& row, float* cells);

}  // namespace vantage::kernels
