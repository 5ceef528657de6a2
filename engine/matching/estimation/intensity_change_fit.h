#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/matching/costs/intensity_change.h"

namespace vantage {

/// Intensities of a pixel and its match in the other image.
struct IntensityPair {
  float reference = 0;
  float other = 0;
};

/// Fits reference ≈ gain · other + offset: the line through the means whose gain is the ratio of
/// the standard deviations, which is unbiased if both images have the same relative noise. Wrong
/// matches are down-weighted iteratively (Tukey's biweight). The order of summation is that of the
/// pairs.
///
/// Empty if the pairs do not determine it: fewer than kMinIntensityPairs, less than half of them on
/// one line, hardly any contrast, or a gain outside 1/4..4.
std::optional<IntensityChange> fit_intensity_change(std::span<const IntensityPair> pairs);
inline constexpr std::size_t kMinIntensityPairs = 200;

/// 1.4826 · the median of `residuals`: σ of a Gaussian with these magnitudes, with few outliers.
/// Residuals ≥ 0, at least one; they are reordered.
double robust_sigma(std::span<float> residuals);

/// The 90 % quantile of `residuals` over that of a unit Gaussian's magnitudes: σ if up to a tenth
/// are outliers, also when most residuals are 0 and the median is too. Residuals ≥ 0, at least one;
/// they are reordered.
double noise_sigma(std::span<float> residuals);

}  // namespace vantage
