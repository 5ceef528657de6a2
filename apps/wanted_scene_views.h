#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/settings.h"
#include "engine/scene_graph/scene_layout.h"

namespace vantage::apps {

/// Views at equal steps from one position to another, both included.
struct SceneSweep {
  ScenePosition first;
  ScenePosition last;
  int views = 0;
};

/// Which views of a scene a user wants: one of these.
struct WantedSceneViews {
  std::vector<ScenePosition> at;
  std::optional<SceneSweep> sweep;
  std::string path_file;  ///< a view for every frame between its positions
};

/// --at, --sweep and --path, in the group that has begun.
void add_wanted_scene_views(Settings& settings, WantedSceneViews& wanted);

/// The positions in order, 1 to 10000, in the unit of the scene. Throws UsageError unless exactly
/// one way of naming views is used and for a path through cameras, Error where its file cannot be
/// read.
std::vector<ScenePosition> scene_positions_of(const WantedSceneViews& wanted);

}  // namespace vantage::apps
