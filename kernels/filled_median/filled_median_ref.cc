#include "kernels/filled_median/filled_median.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace vantage::kernels {
namespace {

struct WeightedSample {
  float disparity_px;
  int weight;
};
using Samples =
    std::array<WeightedSample, std::size_t{kFilledMedianSamples * kFilledMedianSamples}>;

FilledMedianWeights make_weights() {
  FilledMedianWeights weights{};
  for (std::size_t sum = 0; sum < weights.size(); ++sum) {
    weights[sum] = static_cast<std::int32_t>(
        std::lround(kFilledUnitWeight * std::exp(-static_cast<double>(sum) / kFilledMedianLevels)));
  }
  return weights;
}

int difference(const std::uint8_t* a, const std::uint8_t* b) {
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
}

/// Quickselect that counts weights. `count` ≥ 1 samples with `total` > 0 weight; they are
/// reordered. Equal samples, which are frequent, are separated together.
float weighted_median(WeightedSample* samples, int count, int total) {
  int below = 0;  // weight of samples known to be less than the median
  for (;;) {
    const float pivot = samples[count / 2].disparity_px;
    int less = 0;         // samples at the front that are less than the pivot
    int greater = count;  // samples from here on are greater
    int weight_of_less = 0;
    int weight_of_equal = 0;
    for (int i = 0; i < greater;) {
      const WeightedSample sample = samples[i];
      if (sample.disparity_px < pivot) {
        weight_of_less += sample.weight;
        std::swap(samples[i++], samples[less++]);
      } else if (sample.disparity_px > pivot) {
        std::swap(samples[i], samples[--greater]);
      } else {
        weight_of_equal += sample.weight;
        ++i;
      }
    }
    if (2 * (below + weight_of_less) >= total && less > 0) {
      count = less;
    } else if (2 * (below + weight_of_less + weight_of_equal) >= total) {
      return pivot;
    } else {
      below += weight_of_less + weight_of_equal;
      samples += greater;
      count -= greater;
    }
  }
}

}  // namespace

const FilledMedianWeights& filled_median_weights() {
  static const FilledMedianWeights weights = make_weights();
  return weights;
}

void take_filled_medians_row_ref(const FilledRow& row, float* filled_px) {
  const FilledMedianWeights& weights = filled_median_weights();
  Samples samples;
  for (int x = 0; x < row.width; ++x) {
    if (row.unmatched[x] == 0) {
      continue;
    }
    const std::uint8_t* own = row.pixels + x * kFilledPixelBytes;
    int count = 0;
    int total = 0;
    for (int j = -row.grid.count / 2; j <= row.grid.count / 2; ++j) {
      const std::ptrdiff_t dy = j * row.grid.step_px;
      const float* disparity_px = row.disparity_px + dy * row.disparity_pitch + x;
      const std::uint8_t* pixels = own + dy * row.pixel_pitch;
      for (int i = -row.grid.count / 2; i <= row.grid.count / 2; ++i) {
        const std::ptrdiff_t dx = i * row.grid.step_px;
        const int unlike = difference(pixels + dx * kFilledPixelBytes, own);
        const int weight = weights[static_cast<std::size_t>(unlike)];
        samples[static_cast<std::size_t>(count)] = {disparity_px[dx], weight};
        const bool counts = weight > 0 && !std::isnan(disparity_px[dx]);
        count += counts ? 1 : 0;
        total += counts ? weight : 0;
      }
    }
    if (count > 0) {
      // The addition turns −0 into 0.
      filled_px[x] = weighted_median(samples.data(), count, total) + 0.0F;
    }
  }
}

}  // namespace vantage::kernels
