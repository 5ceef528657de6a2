#pragma once

#include <array>

#include "engine/image/image.h"
#include "perf/quality/true_scenes.h"

namespace vantage::perf {

/// Eight, so that StereoSGBM's 16ths of pixels are spread evenly over the bins.
inline constexpr int kFractionBins = 8;

/// Statistics over the visible pixels within 1 px of the truth.
struct SubPixelFigures {
  /// Percentages of pixels per fraction of their disparity; the first bin is centred on 0.
  std::array<double, kFractionBins> fraction_percent{};
  double mean_absolute_error_px = 0;
  double rms_error_px = 0;
};

/// Compares the left map of a scene with its truth. `map` may be the truth itself, for the
/// distribution of its own fractions. NaN if there is no such pixel.
SubPixelFigures sub_pixel_figures(const DisparityMap& map, const LoadedScene& scene);

/// Ratio of pixel counts in the fullest and the emptiest bin; 1 if fractions are unbiased and the
/// truth's are uniformly distributed.
double fullest_over_emptiest(const SubPixelFigures& figures);

}  // namespace vantage::perf
