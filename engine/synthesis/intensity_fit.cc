#include "engine/synthesis/intensity_fit.h"

#include <cstddef>

namespace vantage {
namespace {

// In grey levels squared: less than one pixel in a thousand that differs from the rest by one.
constexpr double kMinVariance = 1e-3;
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
  if (!(variance * unit * unit >= kMinVariance)) {
    return {};
  }
  const double gain = covariance / variance;
  if (!(gain >= 1 / kLargestGain && gain <= kLargestGain)) {
    return {};
  }
  return {.offset = (mean_right - gain * mean_left) * unit, .gain = gain};
}

std::array<IntensityFit, 4> fit_channels(const kernels::IntensitySums& sums, int channels,
                                         double grey_levels_per_unit) {
  const int colour_channels = channels == 4 ? 3 : channels;
  std::array<IntensityFit, 4> fits;
  for (int c = 0; c < colour_channels; ++c) {
    fits[static_cast<std::size_t>(c)] = fit_intensities(sums, c, grey_levels_per_unit);
  }
  return fits;
}

kernels::BlendWeights blend_weights(const std::array<IntensityFit, 4>& intensity, double alpha,
                                    std::optional<double> chosen_gamma,
                                    double grey_levels_per_unit) {
  const double gamma = chosen_gamma.value_or(alpha);

  kernels::BlendWeights weights;
  weights.alpha = static_cast<float>(alpha);
  for (std::size_t c = 0; c < intensity.size(); ++c) {
    const double a = intensity[c].offset / grey_levels_per_unit;
    const double b = intensity[c].gain;
    weights.left_scale[c] = static_cast<float>(gamma + (1 - gamma) * b);
    weights.left_offset[c] = static_cast<float>((1 - gamma) * a);
    weights.right_scale[c] = static_cast<float>(gamma / b + (1 - gamma));
    weights.right_offset[c] = static_cast<float>(-gamma * a / b);
  }
  return weights;
}

}  // namespace vantage
