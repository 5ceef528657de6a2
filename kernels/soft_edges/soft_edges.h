#pragma once

#include <cstdint>

namespace vantage::kernels {

/// Outlines of one finished scanline of a new view on the baseline.
struct OutlineRow {
  /// Surface at each position, holes filled; NaN = unfilled hole.
  const float* disparity_px = nullptr;
  const float* left_disparity_px = nullptr;   ///< as warped; NaN = undefined
  const float* right_disparity_px = nullptr;  ///< likewise
  int width = 0;
  float gradient_limit_px = 1;  ///< neighbours that differ by more are separated by an outline
  float alpha = 0.5F;           ///< share of the left image where both show one surface
  /// Camera offsets of the images along this row: s = XS − position of the camera, in baselines.
  double left_offset = 0;
  double right_offset = 0;
};

/// Shares are in units of 1/256.
inline constexpr int kWholeShare = 256;

/// Share of each position's two neighbours that shows through at outlines: shares[2x] for position
/// x − 1 and shares[2x + 1] for x + 1, each 0..128. Returns the number of outlines in the row.
///
/// A warp moves the nearer surface by whole pixels and never mixes colours of two surfaces, so its
/// outlines are jagged and harder than any lens produces. At an outline each of the two positions
/// therefore takes a fifth of the other. The outline's exact place is known: half a pixel beyond
/// the last pixel of the nearer surface, which is mapped to a fraction φ = −½..½ outside its
/// position. As φ increases, the nearer surface's share in the farther position rises from 0
/// through the fifth to ½, and the farther surface's share in the nearer position falls likewise.
/// So an outline moves smoothly with the view. If, in the image that shows the farther surface, the
/// distance between the two surfaces differs by less than two pixels from the view, the outline is
/// still partly the photograph's own, and shares are reduced in proportion. Scalar code only:
/// outlines are few. Identical on every instruction set.
int outline_shares_row(const OutlineRow& row, std::uint8_t* shares);

/// pixels[x] += Σ share · (neighbour − pixels[x]), using the original values of all neighbours.
/// Integers are rounded half up. The outermost shares of a row are 0. T is uint8_t, uint16_t or
/// float.
void mix_outlines_row(const std::uint8_t* shares, int width, int channels, std::uint8_t* pixels);
void mix_outlines_row(const std::uint8_t* shares, int width, int channels, std::uint16_t* pixels);
void mix_outlines_row(const std::uint8_t* shares, int width, int channels, float* pixels);

}  // namespace vantage::kernels
