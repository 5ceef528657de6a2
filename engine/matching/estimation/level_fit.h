#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/matching/costs/level_change.h"

namespace vantage {

/// Grey levels of one pixel and of its match in the other image.
struct LevelPair {
  float reference = 0;
  float other = 0;
};

/// reference ≈ gain · other + offset: the line through the means whose gain is the ratio of the
/// standard deviations, which noise of equal share in both images does not bend. Wrong matches are
/// left out by weights (Tukey's biweight), found along the way. Added in the order of the pairs.
///
/// Empty where pairs do not tell: fewer than kLeastLevelPairs, less than half of them on one line,
/// hardly any contrast, or a gain outside 1/4..4.
std::optional<LevelChange> fit_levels(std::span<const LevelPair> pairs);
inline constexpr std::size_t kLeastLevelPairs = 200;

/// 1.4826 · the median of `residuals`, each ≥ 0, which are left in another order: σ of a Gaussian
/// whose magnitudes they are, with few outliers. At least one residual.
double robust_sigma(std::span<float> residuals);

/// The 90 % quantile of `residuals`, each ≥ 0, which are left in another order, over that of a
/// Gaussian's magnitudes: σ where up to a tenth are outliers, and where so many residuals are 0
/// that the median is, too. At least one residual.
double noise_sigma(std::span<float> residuals);

}  // namespace vantage
