#include "kernels/intensity_diffusion/intensity_diffusion.h"

#include <algorithm>

#include "kernels/edge_weights/edge_weights.h"

namespace vantage::kernels {
namespace {

/// Stable up to ¼; below, even a chequerboard fades.
constexpr float kStep = 0.2F;

/// flux[x]: what second[x] gives to first[x]. second null: outside the image.
void flux_row(const float* first, const float* second, int count, float contrast, float* flux) {
  if (second == nullptr) {
    std::fill_n(flux, count, 0.0F);
    return;
  }
  edge_weights_row(first, second, count, {.min = 0, .contrast = contrast}, flux);
  for (int x = 0; x < count; ++x) {
    flux[x] *= second[x] - first[x];
  }
}

}  // namespace

void intensity_diffusion_row(const IntensityDiffusionRow& row) {
  const int width = row.width;
  float* const from_right = row.work + 1;  // [−1, width)
  float* const from_up = from_right + width;
  float* const from_down = from_up + width + 1;
  flux_row(row.centre, row.centre + 1, width - 1, row.contrast, from_right);
  from_right[-1] = from_right[width - 1] = 0;
  flux_row(row.centre, row.up, width, row.contrast, from_up);
  flux_row(row.centre, row.down, width, row.contrast, from_down);
  for (int x = 0; x < width; ++x) {
    row.output[x] =
        row.centre[x] + kStep * ((from_right[x] - from_right[x - 1]) + (from_up[x] + from_down[x]));
  }
}

}  // namespace vantage::kernels
