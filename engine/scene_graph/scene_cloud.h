#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "engine/execution.h"
#include "engine/reprojection/point_cloud.h"
#include "engine/scene_graph/scene_viewer.h"
#include "engine/scene_graph/stored_scene.h"

namespace vantage {

/// Which pixels of a scene's images become points.
struct SceneCloudOptions {
  /// A point is kept if at least so many images, its own counted, see it at the same depth; 1..32.
  int min_images = 3;
  /// How far depths of different images may be apart: in pixels of disparity over the median edge;
  /// above 0.
  double tolerance_px = 1;
  std::optional<double> max_depth = std::nullopt;  ///< in the unit of the world, above 0
  int step_px = 1;                                 ///< every so many columns and rows, 1..1024

  /// Throws UsageError naming the field, its value and its limit.
  void validate() const;
};

/// Fuses the maps of a scene of posed cameras to one cloud with colours and normals, in the frame
/// and the unit of the world.
///
/// Each pixel with a match, unless it is beside a jump of the disparity, is compared with the maps
/// of the images that its image has an edge with. Depths that agree are averaged along its ray. A
/// surface that several images see becomes points once, from the first of them: the next image is
/// always that with the most neighbours before it. Normals come from planes fitted to the
/// disparities around a pixel, and point towards its camera.
///
/// Points are in that order of the images, then of rows. Identical for any `execution`. Thread
/// rule: one thread at a time.
class SceneCloudMaker {
 public:
  using LoadVertex = std::function<SceneVertex(int vertex)>;

  /// `load_vertex` gives the image and the maps of a vertex; they are in memory until all images
  /// that have an edge with it are added. `execution` must outlive the maker. Throws UsageError
  /// for invalid options, and for a scene without poses.
  SceneCloudMaker(const StoredScene& scene, LoadVertex load_vertex,
                  const SceneCloudOptions& options, Execution& execution);
  ~SceneCloudMaker();

  /// Makes the points of the next image. False: there is none.
  bool add_image();
  /// The points of all images. Throws Error if there is none.
  PointCloud finish();

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace vantage
