#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/forward_warp/forward_warp.h"

namespace vantage::kernels {
namespace {

struct WarpedSample {
  int column = 0;
  int target = 0;           // −1 and width represent everything outside the view
  double exact_target = 0;  // x − s·d
  float disparity_px = std::numeric_limits<float>::quiet_NaN();
};

}  // namespace

void forward_warp_row_ref(const ForwardWarpRow& row, float* warped_disparity_px,
                          float* source_column) {
  const double s = row.camera_offset;
  const int step = s >= 0 ? 1 : -1;
  const auto write = [&](int target, double disparity_px, double column) {
    warped_disparity_px[target] = static_cast<float>(disparity_px);
    if (source_column != nullptr) {
      source_column[target] = static_cast<float>(column);
    }
  };
  for (int n = 0; n < row.width; ++n) {
    write(n, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN());
  }

  WarpedSample previous;
  for (int i = 0; i < row.width; ++i) {
    WarpedSample sample;
    sample.column = s >= 0 ? i : row.width - 1 - i;
    if (std::isfinite(row.disparity_px[sample.column])) {
      sample.disparity_px = row.disparity_px[sample.column];
      const double shift = s * sample.disparity_px;
      sample.exact_target = sample.column - shift;
      sample.target = static_cast<int>(
          std::clamp(sample.column + std::floor(0.5 - shift), -1.0, 1.0 * row.width));
      // Targets in reverse order are a surface seen from behind: it has no gaps to fill.
      if ((sample.target - previous.target) * step > 1 &&
          std::abs(sample.disparity_px - previous.disparity_px) <= row.gradient_limit_px) {
        const double spacing = sample.exact_target - previous.exact_target;
        for (int n = previous.target + step; n != sample.target; n += step) {
          if (n >= 0 && n < row.width) {
            const double fraction = (n - previous.exact_target) / spacing;
            const double rise = double{sample.disparity_px} - previous.disparity_px;
            write(n, previous.disparity_px + fraction * rise,
                  previous.column + fraction * (sample.column - previous.column));
          }
        }
      }
      if (sample.target >= 0 && sample.target < row.width) {
        write(sample.target, sample.disparity_px, sample.column);
      }
    }
    previous = sample;
  }
}

}  // namespace vantage::kernels
