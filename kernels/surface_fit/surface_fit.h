#pragma once

#include <cstddef>

namespace vantage::kernels {

/// What a row's disparities are where there is no match, and beyond the map: further from any
/// disparity than planes reach.
constexpr float kNoSurfacePx = 1e9F;

/// One row of a disparity map and its surroundings.
struct SurfaceRow {
  /// Column 0 of the row. Readable and, where there is no match, kNoSurfacePx: radius_px rows above
  /// and below, each from column −radius_px to width − 1 + radius_px + kSurfaceRowSlack.
  const float* disparity_px = nullptr;
  std::ptrdiff_t pitch = 0;  ///< values from row to row
  int radius_px = 1;         ///< of the square window, 1..kMaxSurfaceRadiusPx
  int width = 0;
  /// Planes are cut off at these: a slope goes on beyond what was searched.
  float least_px = -kNoSurfacePx;
  float most_px = kNoSurfacePx;
};

constexpr int kMaxSurfaceRadiusPx = 16;
/// Columns read beyond the windows: a vector less one.
constexpr int kSurfaceRowSlack = 15;

/// Samples lie on a square lattice, up to this many steps on either side of the pixel.
constexpr int kMostSurfaceSteps = 2;
/// A sample counts 1 − (e/this)², e = its distance from the plane in pixels, and nothing beyond.
constexpr float kSurfaceReachPx = 1.5F;
/// The plane is fitted this often, at first about a level one through the pixel itself.
constexpr int kSurfacePasses = 2;
/// Squared slopes, in pixels over the length of the lattice's arms, count this much per sample:
/// enough to choose a level plane where samples say nothing, too little to be seen where they do.
constexpr float kSlopeRidge = 1.0F / 16384;
/// Added to the weight of all samples, so that none is no division by 0.
constexpr float kLeastSurfaceWeight = 1e-6F;

/// Where samples are, seen from the pixel. Steps along the lattice are (step_x, step_y) and
/// (−step_y, step_x): turned against the map's rows and columns, because steps between winners on a
/// slanted surface are as regular as a lattice, and one along them would meet the same phase again.
struct SurfaceLattice {
  int steps = 1;   ///< 1 or kMostSurfaceSteps on either side, in both directions
  int step_x = 1;  ///< columns
  int step_y = 0;  ///< rows
  /// Columns and rows of the place i, j steps along the arms.
  [[nodiscard]] int column(int i, int j) const { return i * step_x - j * step_y; }
  [[nodiscard]] int row(int i, int j) const { return i * step_y + j * step_x; }
};

/// The widest one with all samples in the window.
SurfaceLattice surface_lattice(int radius_px);

/// fitted_px[x] of matched pixels becomes the value there of the plane through the disparities
/// around, within least_px and most_px: weighted least squares, in which what is too far from the
/// plane does not count, so that other surfaces have no say. Winners have steps on slanted
/// surfaces, and sub-pixel fits prefer whole pixels; a plane averages over several of both. A pixel
/// from which the plane would be kSurfaceReachPx away or more keeps its value. `fitted_px` comes
/// with the row's values, width of them; those of unmatched pixels stay. Identical on every
/// instruction set.
void fit_surface_row(const SurfaceRow& row, float* fitted_px);

/// The same, plainly.
void fit_surface_row_ref(const SurfaceRow& row, float* fitted_px);

}  // namespace vantage::kernels
