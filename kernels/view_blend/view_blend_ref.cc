#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "kernels/pixel_row/pixel_row.h"
#include "kernels/view_blend/view_blend.h"

namespace vantage::kernels {
namespace {

// Whether the surface of a warped image at x continues on both sides; it counts as continuing at
// the row's ends.
bool goes_on(const float* disparity_px, int width, int x, float limit) {
  const float before = disparity_px[std::max(x - 1, 0)];
  const float after = disparity_px[std::min(x + 1, width - 1)];
  return std::abs(before - disparity_px[x]) <= limit && std::abs(after - disparity_px[x]) <= limit;
}

float left_weight(const WarpedPairRow& pair, int x, const BlendWeights& weights) {
  const float left_d = pair.left_disparity_px[x];
  const float right_d = pair.right_disparity_px[x];
  const float alpha = weights.alpha;
  const float limit = pair.gradient_limit_px;
  if (std::isnan(left_d) || std::isnan(right_d)) {
    return std::isnan(right_d) ? 1.0F : 0.0F;
  }
  if (alpha >= 1.0F || alpha <= 0.0F) {
    return alpha >= 1.0F ? 1.0F : 0.0F;
  }
  if (std::abs(left_d - right_d) <= limit) {
    const bool left_on = goes_on(pair.left_disparity_px, pair.width, x, limit);
    const bool right_on = goes_on(pair.right_disparity_px, pair.width, x, limit);
    if (left_on == right_on) {
      return alpha;
    }
    const float left = alpha * (left_on ? 1.0F : weights.trust_at_ends);
    const float right = (1.0F - alpha) * (right_on ? 1.0F : weights.trust_at_ends);
    return left / (left + right);
  }
  return left_d > right_d ? 1.0F : 0.0F;
}

template <typename T>
T to_pixel(float value, float left, float right) {
  if constexpr (std::is_same_v<T, float>) {
    return std::clamp(value, std::min({0.0F, left, right}),
                      std::max({kLargestValue<T>, left, right}));
  } else {
    return static_cast<T>(std::clamp(value, 0.0F, kLargestValue<T>) + 0.5F);
  }
}

template <typename T>
int blend_plain(const WarpedPairRow& pair, const BlendWeights& weights, int channels,
                const BlendedRow<T>& view) {
  int holes = 0;
  for (int x = 0; x < pair.width; ++x) {
    const float left_d = pair.left_disparity_px[x];
    const float right_d = pair.right_disparity_px[x];
    T* pixel = view.pixels + x * channels;
    if (std::isnan(left_d) && std::isnan(right_d)) {
      ++holes;
      view.holes[x] = 255;
      view.disparity_px[x] = std::numeric_limits<float>::quiet_NaN();
      if (view.sources != nullptr) {
        view.sources[x] = 0;
      }
      std::fill_n(pixel, channels, T{0});
      continue;
    }
    const float left = left_weight(pair, x, weights);
    const float right = 1.0F - left;
    view.holes[x] = 0;
    if (view.sources != nullptr) {
      view.sources[x] =
          static_cast<std::uint8_t>((left > 0.0F ? kFromLeft : 0) + (left < 1.0F ? kFromRight : 0));
    }
    view.disparity_px[x] = left * (std::isnan(left_d) ? 0.0F : left_d) +
                           right * (std::isnan(right_d) ? 0.0F : right_d);
    for (int c = 0; c < channels; ++c) {
      const float left_value = pair.left_colours[x * pair.lanes + c];
      const float right_value = pair.right_colours[x * pair.lanes + c];
      const float value = left * (weights.left_scale[c] * left_value + weights.left_offset[c]) +
                          right * (weights.right_scale[c] * right_value + weights.right_offset[c]);
      pixel[c] = to_pixel<T>(value, left_value, right_value);
    }
  }
  return holes;
}

}  // namespace

int blend_row_ref(const WarpedPairRow& pair, const BlendWeights& weights, int channels,
                  const BlendedRow<std::uint8_t>& view) {
  return blend_plain(pair, weights, channels, view);
}
int blend_row_ref(const WarpedPairRow& pair, const BlendWeights& weights, int channels,
                  const BlendedRow<std::uint16_t>& view) {
  return blend_plain(pair, weights, channels, view);
}
int blend_row_ref(const WarpedPairRow& pair, const BlendWeights& weights, int channels,
                  const BlendedRow<float>& view) {
  return blend_plain(pair, weights, channels, view);
}

}  // namespace vantage::kernels
