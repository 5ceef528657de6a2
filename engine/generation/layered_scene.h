#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/view_geometry/posed_camera.h"

namespace vantage {

/// Parameters of a layered scene.
struct LayeredSceneOptions {
  int width_px = 640;   ///< 1..16384
  int height_px = 480;  ///< 1..16384
  /// Disparities of the scene, per baseline, lie within [far, near]: 0 < far, 1.5 · far ≤ near.
  /// Defaults: width/80 and 5 · far, i.e. 8 and 40 at 640 pixels.
  std::optional<double> far_disparity_px = std::nullopt;
  std::optional<double> near_disparity_px = std::nullopt;
  int frames_per_cycle = 120;  ///< ≥ 1; period of all movements
  int samples_per_side = 3;    ///< 1..8; colour is the mean of this many samples squared per pixel
  /// Exposure of the right camera (view x = 1): gain · I + offset (grey levels); views on the
  /// baseline interpolate linearly. 0.1..10 and ±255.
  double right_gain = 1;
  double right_offset = 0;
  /// Boards partly or wholly without texture stand in the room in place of spheres, cards and bars.
  bool has_boards = false;
  double noise_sigma = 0;  ///< grey levels, independent per pixel, channel, view, frame; 0..255
  std::uint64_t seed = 1;  ///< of textures and noise

  /// Throws UsageError naming the field, its value and its limit.
  void validate() const;
  [[nodiscard]] double far_disparity_or_default() const;
  [[nodiscard]] double near_disparity_or_default() const;
};

/// Position of a camera, in baselines: (0, 0) is the left camera, (1, 0) the right one, y > 0 is
/// below. All cameras look along Z and share the focal length and the principal point, so every
/// pair is rectified up to the direction of its baseline.
struct SceneView {
  double x = 0;
  double y = 0;
};

/// The surface point on the ray through an image position. World coordinates: left camera at the
/// origin, X right, Y down, Z forward, in baselines.
struct ScenePoint {
  double x = 0;
  double y = 0;
  double z = 0;
  int surface = 0;  ///< index of the surface; the same in every view and frame
};

/// Image and truth of one camera at one time.
struct SceneRendering {
  Photograph image;        ///< 8-bit RGB
  DisparityMap disparity;  ///< at pixel centres, per baseline: focal length / Z; all known
  Mask uniform;            ///< 255 at pixels whose surface has no texture at their centre
};

/// A synthetic moving scene with exact geometry: a wavy wall, a slanted floor, spheres, a column,
/// thin bars and floating slanted cards with shaped outlines. All have colour textures attached to
/// them, so that a surface point has one colour in every view. With boards: two of one colour, two
/// with a textured frame, one of each facing the cameras and one slanted.
///
/// A point at image position p in view A is at p − d · (B − A) in view B (3.5), d its disparity.
/// Thread rule: all members may be called concurrently. Results do not depend on the executor.
class LayeredScene {
 public:
  /// Throws UsageError for invalid options. `execution` must outlive the scene.
  LayeredScene(const LayeredSceneOptions& options, Execution& execution);
  ~LayeredScene();
  LayeredScene(LayeredScene&&) noexcept;
  LayeredScene& operator=(LayeredScene&&) = delete;

  [[nodiscard]] const LayeredSceneOptions& options() const { return options_; }
  /// In pixels, equal in x and y; the principal point is the centre of the image.
  [[nodiscard]] double focal_length_px() const;

  /// The camera of a view, in world coordinates. Throws UsageError unless x and y are within ±16
  /// baselines.
  [[nodiscard]] PosedCamera camera(SceneView view) const;

  /// The view of any camera in the world; black, and disparity NaN, where it looks past the scene.
  /// Disparities are those of the pair at equal depth. `frame` ≥ 0. Throws Error for an invalid
  /// camera, UsageError for a frame or view out of range.
  [[nodiscard]] SceneRendering render(const PosedCamera& camera, int frame) const;
  [[nodiscard]] SceneRendering render(SceneView view, int frame) const;

  /// 255 at the pixels of `from` whose surface point is occluded in `in` or outside its frame
  /// (nearest pixel outside the image). Determined by a ray from `in` to the point.
  [[nodiscard]] Mask occlusion(const PosedCamera& from, const PosedCamera& in, int frame) const;
  [[nodiscard]] Mask occlusion(SceneView from, SceneView in, int frame) const;

  /// The point seen at position (x_px, y_px), which may be between pixel centres or outside the
  /// frame.
  [[nodiscard]] ScenePoint point_at(SceneView view, int frame, double x_px, double y_px) const;

 private:
  struct Content;
  LayeredSceneOptions options_;
  Execution* execution_;
  std::unique_ptr<const Content> content_;
};

}  // namespace vantage
