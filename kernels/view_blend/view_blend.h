#pragma once

#include <cstdint>

#include "kernels/colour_fetch/colour_fetch.h"
#include "kernels/intensity_sums/intensity_sums.h"

namespace vantage::kernels {

/// Weights to blend two warped images (3.12); the intensity transform of each image is scale · I +
/// offset per channel.
struct BlendWeights {
  float alpha = 0.5F;  ///< weight of the left image where both show one surface, 0..1
  float left_scale[4] = {1, 1, 1, 1};
  float left_offset[4] = {};
  float right_scale[4] = {1, 1, 1, 1};
  float right_offset[4] = {};
  /// Weight, 0..1, of an image in which the common surface ends beside the position (a hole or a
  /// larger disparity step), relative to an image in which it continues. Such pixels are often
  /// mixtures of two surfaces. 1 = no reduction.
  float trust_at_ends = 1;
};

/// One finished scanline before hole filling.
template <typename T>
struct BlendedRow {
  T* pixels = nullptr;            ///< [x · channels + c]; 0 at holes
  float* disparity_px = nullptr;  ///< weighted with α like the colours; NaN at holes
  std::uint8_t* holes = nullptr;  ///< 255 where neither image is defined, else 0
  /// Images that contribute to the pixel: the sum of kFromLeft and kFromRight. May be null.
  std::uint8_t* sources = nullptr;
};

/// Flags of a source mask, spaced so that the mask can be viewed as an image.
inline constexpr std::uint8_t kFromLeft = 85;
inline constexpr std::uint8_t kFromRight = 170;

/// Combines two warped scanlines. Both defined with disparities within the limit: blended with α,
/// or with α t / (α t + (1 − α) t') where their trusts t and t' differ. Disparities farther apart:
/// only the nearer pixel (larger disparity) counts, except at α = 1 or 0, where the view is a
/// camera's own and only that camera counts. One defined: only that one counts. Its intensity
/// transform always applies. Integer values are rounded half up and saturated; float values are
/// clamped to 0..1, or to the range of the two source values where that is wider. Returns the
/// number of holes. Identical on every instruction set. T is uint8_t, uint16_t
/// or float; channels 1, 3 or 4.
int blend_row(const WarpedPairRow& pair, const BlendWeights& weights, int channels,
              const BlendedRow<std::uint8_t>& view);
int blend_row(const WarpedPairRow& pair, const BlendWeights& weights, int channels,
              const BlendedRow<std::uint16_t>& view);
int blend_row(const WarpedPairRow& pair, const BlendWeights& weights, int channels,
              const BlendedRow<float>& view);

/// The two images of a row of the view, of one width, number of channels and gradient limit; values
/// of integer types are in range.
struct FetchedPairRow {
  BicubicFetchRow left;
  BicubicFetchRow right;
  /// Rows of the same width that are read next, brought into the cache meanwhile: rows of several
  /// images in turn are no stream that a processor follows by itself. Null: none.
  struct NextRow {
    const void* values = nullptr;
    int bytes_per_position = 0;
  } next[4];
};

/// blend_row() of what fetch_bicubic_row() makes of both rows, without storing it in between.
/// Identical to the two, and on every instruction set.
int blend_fetched_row(const FetchedPairRow& fetched, const BlendWeights& weights,
                      const BlendedRow<std::uint8_t>& view);
int blend_fetched_row(const FetchedPairRow& fetched, const BlendWeights& weights,
                      const BlendedRow<std::uint16_t>& view);
int blend_fetched_row(const FetchedPairRow& fetched, const BlendWeights& weights,
                      const BlendedRow<float>& view);

}  // namespace vantage::kernels
