#include <algorithm>
#include <cmath>
#include <type_traits>

#include "kernels/keys_weights.h"
#include "kernels/pixel_row/pixel_row.h"
#include "kernels/surface_fetch/surface_fetch.h"

namespace vantage::kernels {
namespace {

/// Source tap of each of the taps at −1, 0, 1, 2.
struct Choice {
  int from[4];
  bool is_on_surface;  // one of the inner two is; otherwise the nearest of them was chosen
};

// `size`: image size; `first`: position of tap 0; `fraction`: of the position between the inner two
// taps.
Choice choose(const bool (&on_surface)[4], int first, int size, float fraction) {
  if (!on_surface[1] && !on_surface[2]) {
    const int nearest = std::clamp(fraction < 0.5F ? 1 : 2, -first, size - 1 - first);
    return {{nearest, nearest, nearest, nearest}, false};
  }
  const int inner1 = on_surface[1] ? 1 : 2;
  const int inner2 = on_surface[2] ? 2 : 1;
  return {{on_surface[0] && on_surface[1] ? 0 : inner1, inner1, inner2,
           on_surface[3] && on_surface[2] ? 3 : inner2},
          true};
}

template <typename T>
void fetch(const SurfaceFetchRow<T>& row, float* colours) {
  const int lanes = pixel_lanes(row.channels);
  for (int n = 0; n < row.count; ++n, colours += lanes) {
    std::fill_n(colours, lanes, 0.0F);
    const float d = row.disparity_px[n];
    if (std::isnan(d)) {
      continue;
    }
    const int first_column = row.column[n] - 1;
    const int first_line = row.line[n] - 1;
    Choice columns[4];  // for the taps in each row
    bool row_on_surface[4];
    for (int j = 0; j < 4; ++j) {
      const int line = first_line + j;
      bool on_surface[4];
      for (int i = 0; i < 4; ++i) {
        const int column = first_column + i;
        on_surface[i] =
            line >= 0 && line < row.height && column >= 0 && column < row.width &&
            std::abs(row.map_px[line * row.map_stride + column] - d) <= row.gradient_limit_px;
      }
      columns[j] = choose(on_surface, first_column, row.width, row.fraction_x[n]);
      row_on_surface[j] = columns[j].is_on_surface;
    }
    const Choice lines = choose(row_on_surface, first_line, row.height, row.fraction_y[n]);
    const KeysWeights weight_x = keys_weights(row.fraction_x[n]);
    const KeysWeights weight_y = keys_weights(row.fraction_y[n]);
    for (int c = 0; c < row.channels; ++c) {
      float sum_down[4];
      float smallest = 0;
      float largest = kLargestValue<T>;
      for (int i = 0; i < 4; ++i) {
        float tap[4];
        for (int j = 0; j < 4; ++j) {
          const int line = first_line + lines.from[j];
          const int column = first_column + columns[lines.from[j]].from[i];
          tap[j] = static_cast<float>(row.pixels[line * row.stride + column * row.channels + c]);
        }
        sum_down[i] = (weight_y.at[0] * tap[0] + weight_y.at[1] * tap[1]) +
                      (weight_y.at[2] * tap[2] + weight_y.at[3] * tap[3]);
        smallest = std::min(smallest, *std::min_element(tap, tap + 4));
        largest = std::max(largest, *std::max_element(tap, tap + 4));
      }
      const float sum = (weight_x.at[0] * sum_down[0] + weight_x.at[1] * sum_down[1]) +
                        (weight_x.at[2] * sum_down[2] + weight_x.at[3] * sum_down[3]);
      colours[c] = std::clamp(sum, smallest, largest);
    }
  }
}

}  // namespace

void fetch_surface_row_ref(const SurfaceFetchRow<std::uint8_t>& row, float* colours) {
  fetch(row, colours);
}
void fetch_surface_row_ref(const SurfaceFetchRow<std::uint16_t>& row, float* colours) {
  fetch(row, colours);
}
void fetch_surface_row_ref(const SurfaceFetchRow<float>& row, float* colours) {
  fetch(row, colours);
}

}  // namespace vantage::kernels
