#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/options/settings.h"
#include "engine/scene_graph/scene_builder.h"
#include "engine/scene_graph/scene_layout.h"

namespace vantage::apps {

/// Columns and rows of a grid of cameras.
struct GridSize {
  int columns = 0;
  int rows = 0;
};

/// Which images a scene is made of and where they stand: a sequence of files on a grid, a list, or
/// images with poses.
struct SceneImagesInput {
  std::string images;
  std::optional<GridSize> grid;  ///< empty: one row
  ScenePosition spacing{1, 1};
  std::string positions;   ///< file; empty: `images` on a grid
  std::string poses;       ///< file or COLMAP model; empty: no poses
  std::string intrinsics;  ///< file; of the camera of a trajectory
  std::optional<LensKind> lens;
};

/// --images, --grid, --spacing, --positions, --poses, --intrinsics and --lens, in the group that
/// has begun.
void add_scene_images_settings(Settings& settings, SceneImagesInput& input);

/// Throws UsageError when options do not go together, Error when there are no such files, or not
/// as many as the grid has places. Adds to `remarks` which images are left out.
std::vector<SceneImage> scene_images(const SceneImagesInput& input, const Settings& settings,
                                     std::vector<std::string>& remarks);

/// "X,Y" as a position in the scene's unit. Throws UsageError.
ScenePosition to_scene_position(const SettingValue& value);

}  // namespace vantage::apps
