#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/photograph_position/photograph_position.h"

namespace vantage::kernels {

void photograph_positions_row_ref(const PhotographTable& table, const SourcePositions& positions,
                                  int count) {
  for (int n = 0; n < count; ++n) {
    if (std::isnan(positions.disparity_px[n])) {
      continue;
    }
    const int column = std::clamp(positions.column[n], 0, std::max(table.width - 2, 0));
    const int line = std::clamp(positions.line[n], 0, std::max(table.height - 2, 0));
    const float fraction_x =
        positions.fraction_x[n] + static_cast<float>(positions.column[n] - column);
    const float fraction_y = positions.fraction_y[n] + static_cast<float>(positions.line[n] - line);
    const std::ptrdiff_t at = line * table.stride + column;
    const std::ptrdiff_t right = table.width > 1 ? 1 : 0;
    const std::ptrdiff_t down = table.height > 1 ? table.stride : 0;
    // Interpolates small differences: only the last addition rounds to the precision of positions.
    const auto between = [&](const float* values) {
      const float along = values[at + right] - values[at];
      const float along_below = values[at + down + right] - values[at + down];
      return values[at] + (fraction_x * along + fraction_y * ((values[at + down] - values[at]) +
                                                              fraction_x * (along_below - along)));
    };
    float x = between(table.x_px);
    float y = between(table.y_px);
    const bool is_seen = x >= -0.5F && x <= static_cast<float>(table.photograph_width) - 0.5F &&
                         y >= -0.5F && y <= static_cast<float>(table.photograph_height) - 0.5F;
    if (!is_seen) {
      x = y = 0;
      positions.disparity_px[n] = std::numeric_limits<float>::quiet_NaN();
    }
    positions.column[n] = static_cast<std::int32_t>(std::floor(x));
    positions.line[n] = static_cast<std::int32_t>(std::floor(y));
    positions.fraction_x[n] = x - std::floor(x);
    positions.fraction_y[n] = y - std::floor(y);
  }
}

}  // namespace vantage::kernels
