#pragma once

#include <optional>

#include "engine/execution.h"
#include "engine/image/image.h"

namespace vantage {

/// What turns disparities of a rectified pair into depths: Z = f · b / (d + doffs).
struct DepthScale {
  double focal_length_px = 1;  ///< f, above 0
  double baseline = 1;         ///< b, above 0; its unit is that of depths
  double doffs_px = 0;         ///< cx of the right − cx of the left image

  friend bool operator==(const DepthScale&, const DepthScale&) = default;
};

/// Depth at a disparity; empty at infinity and beyond.
std::optional<double> depth(const DepthScale& scale, double disparity_px);

/// δZ, the distance to the next farther depth that can be told from the one at this disparity, at a
/// resolution of `step_px` (δ, above 0) of disparities: δZ = δ / (f b) · Z (Z + δZ) (4.1). Empty if
/// that is infinity. δZ / Z does not depend on f and b.
std::optional<double> depth_resolution(const DepthScale& scale, double step_px,
                                       double disparity_px);

/// Known disparities of a map that stand for all of them.
struct DisparityQuantiles {
  float nearest_px = 0;
  float median_px = 0;
  float farthest_px = 0;
};

/// Disparities of a map and what makes depths of them.
struct DisparitiesAndScale {
  DisparityQuantiles disparities;
  DepthScale scale;
};

/// Empty if no disparity is known.
std::optional<DisparityQuantiles> disparity_quantiles(ImageView<const float> disparity_px);

/// depth_resolution() for each pixel of a map, NaN = unknown or infinite. Resizes `resolution`.
/// Identical for any `execution`.
void depth_resolution_map(ImageView<const float> disparity_px, const DepthScale& scale,
                          double step_px, Execution& execution, Image<float>& resolution);

}  // namespace vantage
