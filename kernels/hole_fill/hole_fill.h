#pragma once

#include <cstdint>

namespace vantage::kernels {

/// One scanline of a new view with holes.
template <typename T>
struct HoleFillRow {
  T* pixels = nullptr;                  ///< [x · channels + c]; values at holes are replaced
  const float* disparity_px = nullptr;  ///< NaN = hole
  int width = 0;
  int channels = 0;
  float gradient_limit_px = 1;  ///< a larger step between neighbours ends the surface
  /// Number of background pixels beside a hole that are filled with it, because they are often
  /// mixtures with the occluding surface. Applies where the two sides of the hole are different
  /// surfaces, and only as far as the background surface extends. ≥ 0.
  int mixed_px = 0;
  /// May be null. Disparities with holes filled from the background, NaN if there is none.
  float* filled_disparity_px = nullptr;
  std::uint8_t* filled = nullptr;  ///< may be null: 255 where pixels were replaced, else 0
};

/// Fills every hole from its background side: the side whose bordering pixel has the smaller
/// disparity (the left one on ties; the only side if the hole touches the image border). The
/// surface there, s0, s1, … counted from the hole, ends at another hole, a disparity jump or the
/// image border, and is reflected at both ends: s0 … sm sm … s0 s0 …. Without `mirror`: s0
/// throughout. A row that is a single hole is unchanged. Values are copied, never mixed; holes are
/// filled from left to right. Scalar code only: holes are few and their source runs backward.
void fill_holes_row(const HoleFillRow<std::uint8_t>& row, bool mirror);
void fill_holes_row(const HoleFillRow<std::uint16_t>& row, bool mirror);
void fill_holes_row(const HoleFillRow<float>& row, bool mirror);

}  // namespace vantage::kernels
