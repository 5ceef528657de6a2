#pragma once

#include <array>
#include <cstddef>

namespace vantage::kernels {

/// Value of disparities without a match and beyond the map: farther from any disparity than planes
/// reach.
constexpr float kNoSurfacePx = 1e9F;

/// One row of a disparity map and its neighbourhood.
struct SurfaceRow {
  /// Column 0 of the row. Must be readable, with kNoSurfacePx where there is no match: radius_px
  /// rows above and below, each from column −radius_px to width − 1 + radius_px + kSurfaceRowSlack.
  const float* disparity_px = nullptr;
  std::ptrdiff_t pitch = 0;  ///< values between rows
  int radius_px = 1;         ///< radius of the square window, 1..kMaxSurfaceRadiusPx
  int width = 0;
  /// Planes are clamped to this range: a slope may continue beyond the search range.
  float min_px = -kNoSurfacePx;
  float max_px = kNoSurfacePx;
};

constexpr int kMaxSurfaceRadiusPx = 16;
/// Columns read beyond the windows: a vector less one lane.
constexpr int kSurfaceRowSlack = 15;

/// Maximum number of steps to samples on a square lattice, on either side of the pixel.
constexpr int kMaxSurfaceSteps = 2;
/// A sample's weight is proportional to 1 − (e/this)², where e is its distance from the plane in
/// pixels, and 0 beyond.
constexpr float kSurfaceReachPx = 1.5F;
/// Of fits to blocks: samples n steps from the centre weigh exp(−n²/this).
constexpr double kSurfaceFalloffSteps2 = 6;
/// Number of fits; the first is relative to a horizontal plane through the pixel.
constexpr int kSurfacePasses = 2;
/// Weight of squared slopes per sample, in pixels over the length of the lattice's arms: enough to
/// select a horizontal plane where samples give no information, too little to matter where they do.
constexpr float kSlopeRidge = 1.0F / 16384;
/// Added to the total weight, to avoid a division by 0 without samples.
constexpr float kMinSurfaceWeight = 1e-6F;

/// Sample positions relative to the pixel. Steps along the lattice are (step_x, step_y) and
/// (−step_y, step_x). The lattice is rotated against the map's rows and columns, because steps
/// between winners on a slanted surface are regular, and a lattice along them would sample the same
/// phase repeatedly.
struct SurfaceLattice {
  int steps = 1;   ///< 1 or kMaxSurfaceSteps on either side, in both directions
  int step_x = 1;  ///< columns
  int step_y = 0;  ///< rows
  /// A sample on the plane has the weight falloff[i² + j²].
  std::array<float, 9> falloff = {1, 1, 1, 1, 1, 1, 1, 1, 1};
  [[nodiscard]] float falloff_at(int i, int j) const {
    return falloff[static_cast<std::size_t>(i * i + j * j)];
  }
  /// Column and row offsets of the position i, j steps along the arms.
  [[nodiscard]] int column(int i, int j) const { return i * step_x - j * step_y; }
  [[nodiscard]] int row(int i, int j) const { return i * step_y + j * step_x; }
};

/// The widest lattice whose samples all lie in the window.
SurfaceLattice surface_lattice(int radius_px);

/// fitted_px[x] of matched pixels becomes the value at the pixel of the plane through the
/// surrounding disparities, clamped to [min_px, max_px]. The fit is weighted least squares;
/// samples too far from the plane have weight 0, so other surfaces do not affect it. Winners form
/// steps on slanted surfaces, and sub-pixel fits prefer whole pixels; a plane averages over several
/// of both. A pixel keeps its value if the plane is kSurfaceReachPx or more away. On entry
/// `fitted_px` holds the row's `width` values; those of unmatched pixels stay. Identical on every
/// instruction set.
void fit_surface_row(const SurfaceRow& row, float* fitted_px);

/// Scalar reference.
void fit_surface_row_ref(const SurfaceRow& row, float* fitted_px);

}  // namespace vantage::kernels
