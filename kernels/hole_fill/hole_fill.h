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
};

/// Fills every hole from its background side: the side whose bordering pixel has the smaller
/// disparity (the left one if equal; its only side if it touches the image border). The surface
/// there, s0, s1, … counted from the hole, runs until another hole, a disparity jump or the image
/// border, and is reflected at either end: s0 … sm sm … s0 s0 …. `mirror` off: s0 throughout.
/// A row that is all hole stays as it is. Values are copied, never mixed.
/// One plain version: holes are few and their source runs backward.
void fill_holes_row(const HoleFillRow<std::uint8_t>& row, bool mirror);
void fill_holes_row(const HoleFillRow<std::uint16_t>& row, bool mirror);
void fill_holes_row(const HoleFillRow<float>& row, bool mirror);

}  // namespace vantage::kernels
