#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/source_position/source_position.h"

namespace vantage::kernels {

void source_positions_row_ref(const SourceProjection& source, const SourcePositionRow& row,
                              const SourcePositions& positions) {
  const double* g = source.homography;
  const double v = row.line;
  for (int u = 0; u < row.count; ++u) {
    positions.column[u] = positions.line[u] = 0;
    positions.fraction_x[u] = positions.fraction_y[u] = 0;
    positions.disparity_px[u] = positions.nearness[u] = std::numeric_limits<float>::quiet_NaN();
    const double q = row.nearness[u];
    if (std::isinf(q)) {
      continue;
    }
    double d = q;
    double x = 0;
    double y = 0;
    if (source.is_translation) {
      d = q + source.infinity_disparity_px;
      x = u - source.parallax[0] * d;
      y = v - source.parallax[1] * d;
    } else {
      const double inverse_ratio = (g[6] * u + (g[7] * v + g[8])) - source.parallax[2] * q;
      if (!(inverse_ratio > kLeastDepthRatio)) {
        continue;
      }
      const double depth_ratio = 1 / inverse_ratio;
      x = ((g[0] * u + (g[1] * v + g[2])) - source.parallax[0] * q) * depth_ratio;
      y = ((g[3] * u + (g[4] * v + g[5])) - source.parallax[1] * q) * depth_ratio;
      d = q * depth_ratio + source.infinity_disparity_px;
    }
    x = std::clamp(x, -1.0, row.source_width - 0.5);
    y = std::clamp(y, -1.0, row.source_height - 0.5);
    positions.column[u] = static_cast<std::int32_t>(std::floor(x));
    positions.line[u] = static_cast<std::int32_t>(std::floor(y));
    positions.fraction_x[u] = static_cast<float>(x - std::floor(x));
    positions.fraction_y[u] = static_cast<float>(y - std::floor(y));
    positions.disparity_px[u] = static_cast<float>(d);
    positions.nearness[u] = row.nearness[u];
  }
}

}  // namespace vantage::kernels
