#pragma once

#include <cstdint>

#include "kernels/intensity_sums/intensity_sums.h"

namespace vantage::kernels {

/// How two warped images become one (3.12), with the intensity transform of each image written as
/// scale · I + offset per channel.
struct BlendWeights {
  float alpha = 0.5F;  ///< weight of the left image where both show one surface, 0..1
  float left_scale[4] = {1, 1, 1, 1};
  float left_offset[4] = {};
  float right_scale[4] = {1, 1, 1, 1};
  float right_offset[4] = {};
  /// Where both show one surface and it ends beside the position in one of them (a hole or a
  /// larger step of disparity), that image's pixel is often a mixture of two surfaces. This is what
  /// it then counts, 0..1, beside an image in which the surface goes on; 1 = alike.
  float trust_at_ends = 1;
};

/// One finished scanline before its holes are filled.
template <typename T>
struct BlendedRow {
  T* pixels = nullptr;            ///< [x · channels + c]; 0 at holes
  float* disparity_px = nullptr;  ///< α-weighted like the colours; NaN at holes
  std::uint8_t* holes = nullptr;  ///< 255 where neither image is defined, else 0
  /// Which images the pixel is made of: the sum of kFromLeft and kFromRight. May be null.
  std::uint8_t* sources = nullptr;
};

/// Parts of a source mask, far enough apart to be looked at.
inline constexpr std::uint8_t kFromLeft = 85;
inline constexpr std::uint8_t kFromRight = 170;

/// Combines two warped scanlines. Both defined with disparities within the limit: blended by α, or
/// where their trust t differs by α t / (α t + (1 − α) t'). Far apart: the nearer (larger
/// disparity) alone, except that at α = 1 or 0 the view is a camera's own and that camera alone
/// decides. One defined: it alone. Its intensity transform always applies. Integer values are
/// rounded half up and saturated; float values stay within 0..1, or the range of the two source
/// values where that is wider. Returns the number of holes. Identical on every instruction set and
/// to the reference. T is uint8_t, uint16_t or float; channels 1, 3 or 4.
int blend_row(const WarpedPairRow& pair, const BlendWeights& weights, int channels,
              const BlendedRow<std::uint8_t>& view);
int blend_row(const WarpedPairRow& pair, const BlendWeights& weights, int channels,
              const BlendedRow<std::uint16_t>& view);
int blend_row(const WarpedPairRow& pair, const BlendWeights& weights, int channels,
              const BlendedRow<float>& view);

int blend_row_ref(const WarpedPairRow& pair, const BlendWeights& weights, int channels,
                  const BlendedRow<std::uint8_t>& view);
int blend_row_ref(const WarpedPairRow& pair, const BlendWeights& weights, int channels,
                  const BlendedRow<std::uint16_t>& view);
int blend_row_ref(const WarpedPairRow& pair, const BlendWeights& weights, int channels,
                  const BlendedRow<float>& view);

}  // namespace vantage::kernels
