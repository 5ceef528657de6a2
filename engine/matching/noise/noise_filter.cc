#include "engine/matching/noise/noise_filter.h"

#include <algorithm>
#include <cmath>

#include "engine/image/intensity_rows.h"
#include "engine/image/memory_use.h"
#include "kernels/bilateral/bilateral.h"

namespace vantage {
namespace {

constexpr int kRadius = kernels::kBilateralRadius;

kernels::BilateralRow row_of(int width, const NoiseFilter& filter) {
  kernels::BilateralRow row{.width = width,
                            .cut_off = static_cast<float>(filter.cut_off_grey_levels)};
  for (int v = -kRadius; v <= kRadius; ++v) {
    for (int u = -kRadius; u <= kRadius; ++u) {
      row.weights[static_cast<std::size_t>(v + kRadius)][static_cast<std::size_t>(u + kRadius)] =
          static_cast<float>(std::exp(-(u * u + v * v) / (2 * filter.sigma_px * filter.sigma_px)));
    }
  }
  return row;
}

}  // namespace

NoiseFilter filter_of(const FoundNoise& noise) {
  switch (noise.kind) {
    case NoiseKind::kNone:
      break;
    case NoiseKind::kCodec:
      return {.sigma_px = 1, .cut_off_grey_levels = 20};
    case NoiseKind::kSensor:
      return {.sigma_px = 2, .cut_off_grey_levels = 4 * noise.grey_levels};
  }
  return {};
}

const Photograph& SmoothedPhotograph::make(const Photograph& photograph, int channels,
                                           const NoiseFilter& filter, Execution& execution) {
  const int width = photograph.width();
  const int height = photograph.height();
  Image<float>& result = pixels_of<float>(result_);
  result.resize(width, height, channels);
  result_.left_out = Mask::borrowed(photograph.left_out.view());
  const kernels::BilateralRow smoothing = row_of(width, filter);
  const int columns = smoothing.width_in_whole_columns();
  padded_.resize(columns + 2 * kRadius, height);
  for (int c = 0; c < channels; ++c) {
    execution.for_each_row(height, [&](int y) {
      float* const grey = padded_.row(y) + kRadius;
      if (channels == 1) {
        intensity_row(photograph, y, grey);
      } else {
        channel_intensity_row(photograph, c, y, grey);
      }
      std::fill_n(grey - kRadius, kRadius, grey[0]);
      std::fill(grey + width, grey + columns + kRadius, grey[width - 1]);
    });
    execution.for_each_band(height, [&](int first_row, int end_row) {
      const auto work =
          execution.scratch().lease(sizeof(float) * static_cast<std::size_t>(columns));
      kernels::BilateralRow row = smoothing;
      row.output = reinterpret_cast<float*>(work.data());
      for (int y = first_row; y < end_row; ++y) {
        for (int v = -kRadius; v <= kRadius; ++v) {
          row.rows[static_cast<std::size_t>(v + kRadius)] =
              padded_.row(std::clamp(y + v, 0, height - 1)) + kRadius;
        }
        kernels::bilateral_row(row);
        float* const pixels = result.row(y) + c;
        for (int x = 0; x < width; ++x) {
          pixels[x * channels] = row.output[x] * (1 / kGreyLevelsPerUnit<float>);
        }
      }
    });
  }
  return result_;
}

std::size_t SmoothedPhotograph::held_bytes() const {
  return vantage::held_bytes(result_) + vantage::held_bytes(padded_);
}

}  // namespace vantage
