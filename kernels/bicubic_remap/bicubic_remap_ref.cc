#include <algorithm>
#include <cmath>
#include <type_traits>

#include "kernels/bicubic_remap/bicubic_remap.h"
#include "kernels/keys_weights.h"
#include "kernels/pixel_row/pixel_row.h"

namespace vantage::kernels {
namespace {

template <typename T>
T stored(float sum, float smallest_tap, float largest_tap) {
  if constexpr (std::is_same_v<T, float>) {
    return std::clamp(sum, std::min(0.0F, smallest_tap), std::max(1.0F, largest_tap));
  } else {
    return static_cast<T>(std::clamp(sum, 0.0F, kLargestValue<T>) + 0.5F);
  }
}

template <typename T>
void remap(const RemapRow<T>& row, T* result) {
  for (int n = 0; n < row.count; ++n, result += row.channels) {
    const float x = row.x_px[n];
    const float y = row.y_px[n];
    if (!(x >= -0.5F && x <= static_cast<float>(row.width) - 0.5F && y >= -0.5F &&
          y <= static_cast<float>(row.height) - 0.5F)) {
      std::fill_n(result, row.channels, T{0});
      continue;
    }
    const float whole_x = std::floor(x);
    const float whole_y = std::floor(y);
    const KeysWeights weight_x = keys_weights(x - whole_x);
    const KeysWeights weight_y = keys_weights(y - whole_y);
    for (int c = 0; c < row.channels; ++c) {
      float sum_down[4];
      float smallest = 0.0F;
      float largest = 0.0F;
      for (int i = 0; i < 4; ++i) {
        const int column = std::clamp(static_cast<int>(whole_x) - 1 + i, 0, row.width - 1);
        float tap[4];
        for (int j = 0; j < 4; ++j) {
          const int line = std::clamp(static_cast<int>(whole_y) - 1 + j, 0, row.height - 1);
          tap[j] = static_cast<float>(row.pixels[line * row.stride + column * row.channels + c]);
        }
        sum_down[i] = (weight_y.at[0] * tap[0] + weight_y.at[1] * tap[1]) +
                      (weight_y.at[2] * tap[2] + weight_y.at[3] * tap[3]);
        smallest = std::min(smallest, *std::min_element(tap, tap + 4));
        largest = std::max(largest, *std::max_element(tap, tap + 4));
      }
      const float sum = (weight_x.at[0] * sum_down[0] + weight_x.at[1] * sum_down[1]) +
                        (weight_x.at[2] * sum_down[2] + weight_x.at[3] * sum_down[3]);
      result[c] = stored<T>(sum, smallest, largest);
    }
  }
}

}  // namespace

void remap_bicubic_row_ref(const RemapRow<std::uint8_t>& row, std::uint8_t* result) {
  remap(row, result);
}
void remap_bicubic_row_ref(const RemapRow<std::uint16_t>& row, std::uint16_t* result) {
  remap(row, result);
}
void remap_bicubic_row_ref(const RemapRow<float>& row, float* result) { remap(row, result); }

}  // namespace vantage::kernels
