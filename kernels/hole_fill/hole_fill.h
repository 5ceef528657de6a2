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
  /// So many pixels of the background beside a hole are filled with it, because they are often
  /// mixtures with the surface that hid the rest: where the hole's two sides are different
  /// surfaces, and as far as the background goes on behind them. ≥ 0.
  int mixed_px = 0;
  /// May be null: disparities with those of the background in the holes, NaN if there is none.
  float* filled_disparity_px = nullptr;
  std::uint8_t* filled = nullptr;  ///< may be null: 255 where pixels have been replaced, else 0
};

/// Fills every hole from its background side: the side whose bordering pixel has the smaller
/// disparity (the left one if equal; its only side if it touches the image border). The surface
/// there, s0, s1, … counted from the hole, runs until another hole, a disparity jump or the image
/// border, and is reflected at either end: s0 … sm sm … s0 s0 …. `mirror` off: s0 throughout.
/// A row that is all hole stays as it is. Values are copied, never mixed; holes are filled from
/// left to right. One plain version: holes are few and their source runs backward.
void fill_holes_row(const HoleFillRow<std::uint8_t>& row, bool mirror);
void fill_holes_row(const HoleFillRow<std::uint16_t>& row, bool mirror);
void fill_holes_row(const HoleFillRow<float>& row, bool mirror);

}  // namespace vantage::kernels
