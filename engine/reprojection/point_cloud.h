#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/reprojection/map_camera.h"

namespace vantage {

// Thread rule: all functions here are pure; those with an `execution` run on its threads.

inline constexpr int kMaxCloudStep_px = 1024;

/// Which pixels of a map become points.
struct CloudOptions {
  std::optional<double> max_depth =
      std::nullopt;  ///< in the unit of the camera, above 0; empty: no limit
  int step_px = 1;   ///< every so many columns and rows, 1..1024
  /// Points have at least this confidence, whose scale depends on the method (MatchedMap).
  std::optional<double> min_confidence = std::nullopt;
  /// Pixels without a match of their own, whose disparities are guessed.
  bool keeps_filled = false;
  /// Pixels at the outlines of surfaces, see outline_mask().
  bool keeps_outlines = false;
  /// Neighbours that differ by more than this are not of one surface; above 0.
  double gradient_limit_px = 1;
  bool with_confidence = false;  ///< points have their confidence
  bool may_be_empty = false;     ///< no point, or no triangle, is no error

  /// Throws UsageError naming the field, its value and its limit.
  void validate() const;
  [[nodiscard]] bool reads_confidence() const { return with_confidence || min_confidence; }
};

/// A map and what belongs to it, all of equal size. Nothing is owned.
struct CloudSource {
  ImageView<const float> disparity_px = {};
  const Photograph* colours = nullptr;           ///< the rectified image; null: points are grey
  ImageView<const std::uint8_t> unmatched = {};  ///< 255 where filled; empty: no pixel is
  ImageView<const float> confidence = {};        ///< if CloudOptions::reads_confidence()
  MapCamera camera = {};
};

struct PointCloud {
  std::vector<float> positions;       ///< x, y, z of each point
  std::vector<float> normals;         ///< x, y, z of each point, unit vectors, or empty
  std::vector<std::uint8_t> colours;  ///< red, green, blue of each point
  std::vector<float> confidence;      ///< of each point, or empty

  [[nodiscard]] std::size_t size() const { return positions.size() / 3; }
};

struct TriangleMesh {
  PointCloud vertices;
  /// Three vertices per triangle, whose front (counter-clockwise) faces the camera.
  std::vector<std::int32_t> triangles;
};

/// 255 at pixels that may mix the colours or disparities of two surfaces: one of their four
/// neighbours differs from them by more than the limit. Both sides of a jump are set. Unknown
/// neighbours do not count.
void outline_mask(ImageView<const float> disparity_px, double gradient_limit_px,
                  Execution& execution, Mask& outlines);

/// The points of a map, row by row from its top left. Throws Error if sizes differ, or if no
/// pixel is left and that is an error; UsageError for invalid options. Identical for any
/// `execution`.
PointCloud point_cloud(const CloudSource& source, const CloudOptions& options,
                       Execution& execution);

/// The same points as a surface: two triangles between four points that are neighbours, one between
/// three. There are none where pixels between them are unknown or jump by more than the limit.
/// Points without a triangle are left out. Throws as point_cloud(), also if there is no triangle.
TriangleMesh triangle_mesh(const CloudSource& source, const CloudOptions& options,
                           Execution& execution);

}  // namespace vantage
