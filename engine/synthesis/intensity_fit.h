#pragma once

#include <array>
#include <optional>

#include "kernels/intensity_sums/intensity_sums.h"
#include "kernels/view_blend/view_blend.h"

namespace vantage {

/// I_R ≈ offset + gain · I_L of one channel, in grey levels 0..255 (3.9).
struct IntensityFit {
  double offset = 0;
  double gain = 1;

  friend bool operator==(const IntensityFit&, const IntensityFit&) = default;
};

/// Least squares (3.10) from the sums (3.11) of one channel, whose unit is `grey_levels_per_unit`
/// grey levels. The identity if the fit is degenerate: fewer than two pixels, a left image without
/// contrast, or a gain outside 1/16..16, which includes b ≤ 0 and cannot occur between two cameras
/// of one rig.
IntensityFit fit_intensities(const kernels::IntensitySums& sums, int channel,
                             double grey_levels_per_unit);

/// The fits of all colour channels; the identity for an alpha channel.
std::array<IntensityFit, 4> fit_channels(const kernels::IntensitySums& sums, int channels,
                                         double grey_levels_per_unit);

/// (3.12): each image's colours are adjusted towards the other's by its share of γ.
[[nodiscard]] kernels::BlendWeights blend_weights(const std::array<IntensityFit, 4>& intensity,
                                                  double alpha, std::optional<double> chosen_gamma,
                                                  double grey_levels_per_unit);

}  // namespace vantage
