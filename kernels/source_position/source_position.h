#pragma once

#include <cstdint>

#include "kernels/view_projection/view_projection.h"

namespace vantage::kernels {

/// Inverse of a ViewProjection: (x, y, 1) = λ · (homography · (u, v, 1) − q · parallax).
struct SourceProjection {
  double homography[9] = {1, 0, 0, 0, 1,
                          0, 0, 0, 1};  ///< inverse of the homography of points at infinity
  double parallax[3] = {};              ///< homography · ViewProjection::parallax
  double infinity_disparity_px = 0;
  /// The view is a translation: x = u − parallax_x · d, y = v − parallax_y · d, with the parallax
  /// and the disparity at infinity of the ViewProjection.
  bool is_translation = true;
};

/// Position in the image of a point of nearness q at (u, v) in the new view. The vector form
/// performs the same steps.
struct ExactSource {
  double x = 0;
  double y = 0;
  double disparity_px = 0;
  bool is_visible =
      false;  ///< false: in front of the image's plane; other fields are then meaningless
};

inline ExactSource exact_source(const SourceProjection& source, double u, double v, double q) {
  if (source.is_translation) {
    const double d = q + source.infinity_disparity_px;
    return {u - source.parallax[0] * d, v - source.parallax[1] * d, d, true};
  }
  const double* g = source.homography;
  const double inverse_ratio = (g[6] * u + (g[7] * v + g[8])) - source.parallax[2] * q;
  if (!(inverse_ratio > kMinDepthRatio)) {
    return {};
  }
  const double depth_ratio = 1 / inverse_ratio;
  return {((g[0] * u + (g[1] * v + g[2])) - source.parallax[0] * q) * depth_ratio,
          ((g[3] * u + (g[4] * v + g[5])) - source.parallax[1] * q) * depth_ratio,
          q * depth_ratio + source.infinity_disparity_px, true};
}

/// One line of a new view and its source image.
struct SourcePositionRow {
  const float* nearness = nullptr;  ///< q, starting at column 0; −inf or NaN = hole
  int count = 0;                    ///< ≥ 0
  int line = 0;
  int source_width = 0;
  int source_height = 0;
};

/// Source positions of a row of the new view, `count` values each, clamped to [−1, size − ½] in x
/// and y. Holes, and points in front of the source camera's plane, which it cannot see, have NaN in
/// both `nearness` and `disparity_px` and position (0, 0).
struct SourcePositions {
  std::int32_t* column = nullptr;  ///< integer part (floor) of x
  std::int32_t* line = nullptr;    ///< integer part of y
  float* fraction_x = nullptr;     ///< remainder of x
  float* fraction_y = nullptr;
  float* disparity_px = nullptr;  ///< disparity of the surface there
  float* nearness = nullptr;      ///< q
};

/// Identical on every instruction set.
void source_positions_row(const SourceProjection& source, const SourcePositionRow& row,
                          const SourcePositions& positions);

}  // namespace vantage::kernels
