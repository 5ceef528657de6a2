#pragma once

#include <array>

#include "engine/image/image.h"
#include "perf/quality/true_scenes.h"

namespace vantage::perf {

/// Eight, so that the 16ths of pixels that StereoSGBM knows fall evenly on them.
inline constexpr int kFractionBins = 8;

/// Of the visible pixels within 1 px of the truth.
struct SubPixelFigures {
  /// Percentages of pixels by the fraction of their disparity; the first bin's middle is 0.
  std::array<double, kFractionBins> fraction_percent{};
  double mean_absolute_error_px = 0;
  double rms_error_px = 0;
};

/// The left map of a scene against its truth. `map` may be the truth itself: how its own fractions
/// are distributed. NaN without any such pixel.
SubPixelFigures sub_pixel_figures(const DisparityMap& map, const LoadedScene& scene);

/// How many times as many pixels the fullest bin has as the emptiest; 1 where fractions are not
/// biased and the truth's are distributed evenly.
double fullest_over_emptiest(const SubPixelFigures& figures);

}  // namespace vantage::perf
