#include <algorithm>
#include <cmath>

#include "kernels/colour_fetch/colour_fetch.h"
#include "kernels/keys_weights.h"

namespace vantage::kernels {

void fetch_bicubic_row_ref(const BicubicFetchRow& row, float* colours) {
  for (int n = 0; n < row.width; ++n) {
    const float d = row.warped_disparity_px[n];
    if (std::isnan(d)) {
      std::fill_n(colours + n * row.lanes, row.lanes, 0.0F);
      continue;
    }
    const double column = std::clamp(n + row.camera_offset * d, -1.0, row.width - 0.5);
    const int whole = static_cast<int>(std::floor(column));
    const float f = static_cast<float>(column - whole);

    int tap[4] = {whole - 1, whole, whole + 1, whole + 2};
    bool on_surface[4];
    for (int k = 0; k < 4; ++k) {
      on_surface[k] = std::abs(row.source_disparity_px[tap[k]] - d) <= row.gradient_limit_px;
    }
    if (!on_surface[1] && !on_surface[2]) {
      tap[1] = tap[2] = std::clamp(f < 0.5F ? tap[1] : tap[2], 0, row.width - 1);
      on_surface[0] = on_surface[3] = false;
    } else if (!on_surface[1]) {
      tap[1] = tap[2];
      on_surface[0] = false;
    } else if (!on_surface[2]) {
      tap[2] = tap[1];
      on_surface[3] = false;
    }
    tap[0] = on_surface[0] ? tap[0] : tap[1];
    tap[3] = on_surface[3] ? tap[3] : tap[2];

    const KeysWeights weight = keys_weights(f);
    for (int c = 0; c < row.lanes; ++c) {
      float value[4];
      for (int k = 0; k < 4; ++k) {
        value[k] = row.pixels[tap[k] * row.lanes + c];
      }
      const float sum = (weight.at[0] * value[0] + weight.at[1] * value[1]) +
                        (weight.at[2] * value[2] + weight.at[3] * value[3]);
      const float smallest = std::min(0.0F, *std::min_element(value, value + 4));
      const float largest = std::max(row.largest_value, *std::max_element(value, value + 4));
      colours[n * row.lanes + c] = std::clamp(sum, smallest, largest);
    }
  }
}

}  // namespace vantage::kernels
