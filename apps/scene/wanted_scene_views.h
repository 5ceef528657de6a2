#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/options/settings.h"
#include "engine/scene_graph/scene_layout.h"
#include "engine/view_geometry/posed_camera.h"

namespace vantage::apps {

/// Views at equal steps from one position to another, both included.
struct SceneSweep {
  ScenePosition first;
  ScenePosition last;
  int views = 0;
};

/// Views at equal steps from one image to another, both included.
struct ImageSweep {
  int first = 0;
  int last = 0;
  int views = 0;
};

/// A view on the way from one image to another.
struct BetweenImages {
  int first = 0;
  int second = 0;
  double share = 0.5;  ///< 0 at the first, 1 at the second
};

/// Which views of a scene a user wants: one of these.
struct WantedSceneViews {
  std::vector<ScenePosition> at;
  std::optional<SceneSweep> sweep;
  std::string path_file;  ///< a view for every frame between its positions
  /// Of scenes with poses, which also have a path, through cameras.
  std::vector<BetweenImages> between;
  std::optional<ImageSweep> image_sweep;
  std::string pose_file;
};

/// --at, --sweep, --path, --pose and --between, in the group that has begun.
void add_wanted_scene_views(Settings& settings, WantedSceneViews& wanted);

/// The positions in order, 1 to 10000, in the unit of the scene. Throws UsageError unless exactly
/// one way of naming views is used and for those of scenes with poses, Error where its file cannot
/// be read.
std::vector<ScenePosition> scene_positions_of(const WantedSceneViews& wanted);

/// The cameras in order, 1 to 10000, in the world of a scene with poses, from those of its images.
/// Errors as scene_positions_of(), and for numbers of images that the scene does not have.
std::vector<PosedCamera> scene_cameras_of(const WantedSceneViews& wanted,
                                          const std::vector<PosedCamera>& images);

}  // namespace vantage::apps
