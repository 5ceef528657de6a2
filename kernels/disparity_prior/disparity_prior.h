#pragma once

#include <algorithm>
#include <limits>

#include "kernels/candidates.h"
#include "kernels/cells/exp_log.h"

namespace vantage::kernels {

// Draws pixels towards disparities they are expected to have. Both forms are the same function of
// k = d − d_prior, a parabola with a floor: the energy of a Gaussian that is cut off two pixels
// away. Beyond that a prior no longer tells one candidate from another. As a likelihood its floor
// is e⁻¹ = 0.37 at weight 1: less than what a pixel's own costs can say (whose contamination is εM
// = 0.1), so that a surface that is gone does not stay in the map where the images speak against
// it. And a parabola does not move the vertex of a parabola that is where the prior is: sub-pixel
// positions stay where they were. Identical on every instruction set.

/// Of the prior's energy: it grows as (k / kPriorReachPx)² up to 1.
inline constexpr float kPriorReachPx = 2.0F;
/// −log of the floor of the prior's likelihood.
inline constexpr float kPriorDepth = 1.0F;

/// Cells of one row, `lanes` floats a column, and what their columns are drawn towards.
struct DisparityPriorRow {
  /// A disparity per column; columns whose own lies outside [disparity_min, disparity_min + count −
  /// 1], or is NaN, are left alone.
  const float* prior_px = nullptr;
  int columns = 0;
  int lanes = 0;  ///< a multiple of kLaneMultiple
  int count = 0;  ///< candidates: lanes [0, count)
  int disparity_min = 0;
  /// Of likelihoods: the candidate in lane 0, where cells are those of some candidates only.
  int first_candidate = 0;
  float weight = 1;  ///< ≥ 0
  /// Of energies: most that the contrast of a column counts, see energies_with_prior_row().
  float most_contrast = std::numeric_limits<float>::infinity();

  [[nodiscard]] bool has_prior(int column) const {
    const float offset = prior_px[column] - static_cast<float>(disparity_min);
    return offset >= 0 && offset <= static_cast<float>(count - 1);
  }
};

/// Energies: E += weight · s · min(k²/4, 1), where s, the mean of the column's candidates minus the
/// least of them, but at most most_contrast, gives the prior the unit and the contrast of the
/// costs. All lanes are changed; those of no candidate must be finite and count neither for the
/// mean nor for the least.
void energies_with_prior_row(const DisparityPriorRow& row, float* cells);
void energies_with_prior_row_ref(const DisparityPriorRow& row, float* cells);

/// Exponent (of 2) of the prior's likelihood two pixels away and farther. It ends where products
/// with the least likelihoods would leave the normal floats.
inline float prior_exponent_scale(float weight) {
  constexpr float kLeast = -20.0F;
  return std::max(-kPriorDepth * kLog2E * weight, kLeast);
}

/// Likelihoods: p *= exp(−w · min(k²/4, 1)), w = weight, at most 20 log 2.
void likelihoods_with_prior_row(const DisparityPriorRow& row, float* cells);
void likelihoods_with_prior_row_ref(const DisparityPriorRow& row, float* cells);

}  // namespace vantage::kernels
