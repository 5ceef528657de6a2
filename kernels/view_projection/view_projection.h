#pragma once

#include <cstdint>

namespace vantage::kernels {

/// Mapping from an image to a new view: a pixel (x, y) of disparity d lies at λ (u, v, 1) =
/// homography · (x, y, 1) + d · parallax, (3.8) multiplied by the warp (3.5). Along one ray of the
/// new view, points are ordered by nearness q = (d − infinity_disparity_px) / λ.
struct ViewProjection {
  double homography[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< row-major
  double parallax[3] = {};
  double infinity_disparity_px = 0;  ///< disparity of points at infinity
  /// The homography is the identity and parallax[2] is 0; hence λ = 1.
  bool is_translation = true;
};

/// Points with depth ratio λ up to this are behind the camera or practically in its plane.
inline constexpr double kMinDepthRatio = 1e-9;

/// Targets are clamped to ± this: far outside any view, safe to subtract.
inline constexpr int kFarTargetPx = 1 << 29;

/// Exact position and nearness of one pixel of known disparity. The vector form performs the same
/// steps.
struct ExactTarget {
  double u;
  double v;
  double depth_ratio;  ///< λ; other fields are meaningful only if it exceeds kMinDepthRatio
};

inline ExactTarget exact_target(const ViewProjection& view, double x, double y, double d) {
  if (view.is_translation) {
    return {x + view.parallax[0] * d, y + view.parallax[1] * d, 1};
  }
  const double* h = view.homography;
  const double depth_ratio = (h[6] * x + (h[7] * y + h[8])) + view.parallax[2] * d;
  const double scale = 1 / depth_ratio;
  return {((h[0] * x + (h[1] * y + h[2])) + view.parallax[0] * d) * scale,
          ((h[3] * x + (h[4] * y + h[5])) + view.parallax[1] * d) * scale, depth_ratio};
}

/// Part of a row of a disparity map.
struct ProjectionSource {
  const float* disparity_px = nullptr;  ///< at column `first_column`; NaN or ±inf = unknown
  int count = 0;                        ///< ≥ 0
  int first_column = 0;
  int line = 0;
};

/// Targets of the source's pixels, `count` values each. Dropped points have disparity NaN, nearness
/// −inf and target (0, 0): unknown disparity, λ ≤ kMinDepthRatio, or nearness outside the range
/// of float.
struct ProjectedRow {
  float* disparity_px = nullptr;   ///< of the source
  float* nearness = nullptr;       ///< q
  std::int32_t* column = nullptr;  ///< floor(u + ½); in translations x + floor(½ + parallax · d)
  std::int32_t* line = nullptr;    ///< floor(v + ½), likewise
};

/// Identical on every instruction set.
void project_row(const ViewProjection& view, const ProjectionSource& source,
                 const ProjectedRow& row);

}  // namespace vantage::kernels
