#pragma once

#include <cstdint>

namespace vantage::kernels {

/// One finished scanline of a new view on the baseline, as far as its outlines are concerned.
struct OutlineRow {
  /// Of the surface at each position, holes filled; NaN = hole that stays open.
  const float* disparity_px = nullptr;
  const float* left_disparity_px = nullptr;   ///< as warped; NaN = not defined
  const float* right_disparity_px = nullptr;  ///< likewise
  int width = 0;
  float gradient_limit_px = 1;  ///< neighbours that differ by more have an outline between them
  float alpha = 0.5F;           ///< share of the left image where both show one surface
  /// From where the images were mapped along this row: s = XS − position of the camera, in
  /// baselines.
  double left_offset = 0;
  double right_offset = 0;
};

/// Shares are counted in 256ths.
inline constexpr int kWholeShare = 256;

/// How much of each position's two neighbours shows through at outlines: shares[2x] of position
/// x − 1 and shares[2x + 1] of x + 1, each 0..128. Returns how many outlines the row has.
///
/// A warp moves the nearer surface by whole pixels and never mixes colours of two surfaces, so its
/// outlines come out harder than any lens draws them, and jagged. At an outline each of the two
/// positions therefore takes a fifth of the other. The outline's exact place is known:
/// half a pixel beyond the last pixel of the nearer surface, which is mapped to a fraction
/// φ = −½..½ outside its position. The share of the nearer surface in the farther position rises
/// with φ from 0 over the fifth to ½, that of the farther one in the nearer position falls
/// likewise, so that an outline moves without jumps as the view does. Where the image that shows
/// the farther surface has the two less than two pixels closer or farther apart than the view, the
/// outline is still partly the photograph's own, and shares are smaller in proportion. Plain code:
/// outlines are few. Identical on every instruction set.
int outline_shares_row(const OutlineRow& row, std::uint8_t* shares);

/// pixels[x] += Σ share · (neighbour − pixels[x]), with all neighbours as they were before.
/// Integers are rounded half up. The outermost shares of a row are 0. T is uint8_t, uint16_t or
/// float.
void mix_outlines_row(const std::uint8_t* shares, int width, int channels, std::uint8_t* pixels);
void mix_outlines_row(const std::uint8_t* shares, int width, int channels, std::uint16_t* pixels);
void mix_outlines_row(const std::uint8_t* shares, int width, int channels, float* pixels);

}  // namespace vantage::kernels
