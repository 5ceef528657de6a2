#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/source_position/source_position.h"

namespace vantage::kernels {

void source_positions_row_ref(const SourceProjection& source, const SourcePositionRow& row,
                              const SourcePositions& positions) {
  const double v = row.line;
  for (int u = 0; u < row.count; ++u) {
    positions.column[u] = positions.line[u] = 0;
    positions.fraction_x[u] = positions.fraction_y[u] = 0;
    positions.disparity_px[u] = positions.nearness[u] = std::numeric_limits<float>::quiet_NaN();
    const double q = row.nearness[u];
    if (!(q > -std::numeric_limits<double>::infinity())) {
      continue;
    }
    const ExactSource at = exact_source(source, u, v, q);
    if (!at.is_visible) {
      continue;
    }
    const double x = std::clamp(at.x, -1.0, row.source_width - 0.5);
    const double y = std::clamp(at.y, -1.0, row.source_height - 0.5);
    positions.column[u] = static_cast<std::int32_t>(std::floor(x));
    positions.line[u] = static_cast<std::int32_t>(std::floor(y));
    positions.fraction_x[u] = static_cast<float>(x - std::floor(x));
    positions.fraction_y[u] = static_cast<float>(y - std::floor(y));
    positions.disparity_px[u] = static_cast<float>(at.disparity_px);
    positions.nearness[u] = row.nearness[u];
  }
}

}  // namespace vantage::kernels
