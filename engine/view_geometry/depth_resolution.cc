#include "engine/view_geometry/depth_resolution.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <vector>

#include "engine/image/finite_values.h"
#include "engine/order_statistics.h"

namespace vantage {

std::optional<double> depth(const DepthScale& scale, double disparity_px) {
  const double from_infinity_px = disparity_px + scale.doffs_px;
  if (!(from_infinity_px > 0)) {  // true for NaN
    return std::nullopt;
  }
  return scale.focal_length_px * scale.baseline / from_infinity_px;
}

std::optional<double> depth_resolution(const DepthScale& scale, double step_px,
                                       double disparity_px) {
  const std::optional<double> here = depth(scale, disparity_px);
  const std::optional<double> next = depth(scale, disparity_px - step_px);
  if (!next) {
    return std::nullopt;
  }
  return step_px / (scale.focal_length_px * scale.baseline) * *here * *next;
}

std::optional<DisparityQuantiles> disparity_quantiles(ImageView<const float> disparity_px) {
  std::vector<float> known = finite_values(disparity_px);
  if (known.empty()) {
    return std::nullopt;
  }
  const auto [farthest, nearest] = std::minmax_element(known.begin(), known.end());
  DisparityQuantiles quantiles{.nearest_px = *nearest, .farthest_px = *farthest};
  quantiles.median_px = upper_median(known);
  return quantiles;
}

void depth_resolution_map(ImageView<const float> disparity_px, const DepthScale& scale,
                          double step_px, Execution& execution, Image<float>& resolution) {
  resolution.resize(disparity_px.width(), disparity_px.height());
  execution.for_each_row(disparity_px.height(), [&](int y) {
    for (int x = 0; x < disparity_px.width(); ++x) {
      const auto value =
          depth_resolution(scale, step_px, static_cast<double>(disparity_px.at(x, y)));
      resolution.at(x, y) =
          value ? static_cast<float>(*value) : std::numeric_limits<float>::quiet_NaN();
    }
  });
}

}  // namespace vantage
