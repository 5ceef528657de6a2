#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace vantage::kernels {

/// How disparities are stored for fits: as 16-bit integers, in steps of 2^−fraction_bits pixels
/// from `middle_px`.
struct SurfaceFormat {
  float middle_px = 0;  ///< a multiple of 1/2
  int fraction_bits = 6;
  [[nodiscard]] float units_per_px() const { return static_cast<float>(1 << fraction_bits); }
};

/// Disparities may lie this far outside their search range.
constexpr int kSurfaceRangeMarginPx = 4;
/// The finest format for disparities from min_px to max_px: steps of 1/64 px for a range of up to
/// 971 px, of 1/32 up to 1995, of 1/16 up to 4043, and of 1/8. Disparities that the format does not
/// hold are stored as the nearest that it does; of ranges of more than 8139 px not all fit.
SurfaceFormat surface_format(int min_px, int max_px);

/// Stored disparity without a match and beyond the map: farther from any disparity than planes
/// reach.
constexpr std::int16_t kNoSurface = -32768;

/// One row of a disparity map and its neighbourhood.
struct SurfaceRow {
  /// Column 0 of the row. Must be readable, with kNoSurface where there is no match: radius_px rows
  /// above and below, each from column −radius_px to width − 1 + radius_px + kSurfaceRowSlack.
  const std::int16_t* samples = nullptr;
  std::ptrdiff_t pitch = 0;  ///< values between rows
  SurfaceFormat format = {};
  int radius_px = 1;  ///< radius of the square window, 1..kMaxSurfaceRadiusPx
  int width = 0;
  /// Planes are clamped to this range: a slope may continue beyond the search range.
  float min_px = 0;
  float max_px = 0;
};

constexpr int kMaxSurfaceRadiusPx = 16;
/// Columns read beyond the windows: a vector less one lane.
constexpr int kSurfaceRowSlack = 31;

/// Maximum number of steps to samples on a square lattice, on either side of the pixel.
constexpr int kMaxSurfaceSteps = 2;
/// A sample's weight is proportional to 1 − |e|/this, where e is its distance from the plane in
/// pixels, and 0 beyond. A multiple of 1/8: whole in every format.
constexpr float kSurfaceReachPx = 1.75F;
/// Pixels that a plane would move by this or more keep their value.
constexpr float kMaxSurfaceMovePx = 1.5F;
/// Of fits to blocks: samples n steps from the centre weigh exp(−n²/this).
constexpr double kSurfaceFalloffSteps2 = 6;
/// Weight of squared slopes per sample, in pixels over the length of the lattice's arms: enough to
/// select a horizontal plane where samples give no information, too little to matter where they do.
constexpr float kSlopeRidge = 1.0F / 16384;
/// Bound of the first plane's height and of its slopes per step, so that no plane comes near
/// kNoSurface or the end of 16 bits.
constexpr int kMaxFirstSurfacePx = 4;

/// Sample positions relative to the pixel. Steps along the lattice are (step_x, step_y) and
/// (−step_y, step_x). The lattice is rotated against the map's rows and columns, because steps
/// between winners on a slanted surface are regular, and a lattice along them would sample the same
/// phase repeatedly.
struct SurfaceLattice {
  int steps = 1;   ///< 1 or kMaxSurfaceSteps on either side, in both directions
  int step_x = 1;  ///< columns
  int step_y = 0;  ///< rows
  /// Weight of a sample on the plane at the centre. Sums of products of weight, distance and steps
  /// must fit 16 bits.
  int unit_weight = 32;
  /// A sample on the plane has the weight falloff[i² + j²] · unit_weight.
  std::array<float, 9> falloff = {1, 1, 1, 1, 1, 1, 1, 1, 1};
  /// Column and row offsets of the position i, j steps along the arms.
  [[nodiscard]] int column(int i, int j) const { return i * step_x - j * step_y; }
  [[nodiscard]] int row(int i, int j) const { return i * step_y + j * step_x; }
};

/// The widest lattice whose samples all lie in the window.
SurfaceLattice surface_lattice(int radius_px);

/// Weights of samples in integers: max(0, reach − |e|) · share[i² + j²] / 65536, rounded down,
/// where e is the distance from the plane in steps of the format.
struct SurfaceWeights {
  int reach = 0;
  std::array<std::uint16_t, 9> share = {};
};
SurfaceWeights surface_weights(const SurfaceLattice& lattice, const SurfaceFormat& format);

/// Stores a row of disparities for fits, rounded to the nearest step, halves to even. `unmatched`:
/// ≠ 0 where kNoSurface is stored. Others must be finite.
void surface_sample_row(const float* disparity_px, const std::uint8_t* unmatched, int width,
                        const SurfaceFormat& format, std::int16_t* samples);

/// fitted_px[x] of matched pixels becomes the value at the pixel of the plane through the
/// surrounding disparities, clamped to [min_px, max_px]. The fit is weighted least squares, in two
/// passes, the first of which is relative to a horizontal plane through the pixel; samples too far
/// from the plane have weight 0, so other surfaces do not affect it. Winners form steps on slanted
/// surfaces, and sub-pixel fits prefer whole pixels; a plane averages over several of both. A pixel
/// keeps its value if the plane is kMaxSurfaceMovePx or more away. On entry `fitted_px` holds the
/// row's `width` values; those of unmatched pixels stay. Identical on every instruction set.
void fit_surface_row(const SurfaceRow& row, float* fitted_px);

/// Largest stored disparity: planes through it stay within 16 bits, and those through its negative
/// stay out of reach of kNoSurface.
constexpr int max_surface_sample(const SurfaceFormat& format) {
  // Height, and two steps along both arms; then more than the reach.
  return 32767 - ((5 * kMaxFirstSurfacePx + 2) << format.fraction_bits);
}

}  // namespace vantage::kernels
