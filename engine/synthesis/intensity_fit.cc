#include "engine/synthesis/intensity_fit.h"

namespace vantage {
namespace {

// In grey levels squared: less than one pixel in a thousand that differs from the rest by one.
constexpr double kLeastVariance = 1e-3;
constexpr double kLargestGain = 16;

}  // namespace

IntensityFit fit_intensities(const kernels::IntensitySums& sums, int channel,
                             double grey_levels_per_unit) {
  if (sums.pixels < 2) {
    return {};
  }
  const auto n = static_cast<double>(sums.pixels);
  const double mean_left = sums.left[channel] / n;
  const double mean_right = sums.right[channel] / n;
  const double variance = sums.left_left[channel] / n - mean_left * mean_left;
  const double covariance = sums.left_right[channel] / n - mean_left * mean_right;
  const double unit = grey_levels_per_unit;
  if (!(variance * unit * unit >= kLeastVariance)) {
    return {};
  }
  const double gain = covariance / variance;
  if (!(gain >= 1 / kLargestGain && gain <= kLargestGain)) {
    return {};
  }
  return {.offset = (mean_right - gain * mean_left) * unit, .gain = gain};
}

}  // namespace vantage
