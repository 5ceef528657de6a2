#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/settings/common_options.h"
#include "engine/generation/layered_scene.h"
#include "engine/options/settings.h"
#include "engine/view_geometry/view_pose.h"

namespace vantage::apps {

/// What `generate scene` is asked for.
struct SceneJob {
  LayeredSceneOptions scene;
  CommonOptions common;
  std::string output;
  bool overwrite = false;
  std::optional<int> frames;
  double camera_speed = 0;  ///< baselines per frame
  std::vector<BaselinePosition> views;
  std::string pose_file;
  std::vector<PosedCamera> cameras;  ///< of the pose file
};

/// Renders the frames and what is known of them, until Ctrl-C. Returns the exit code. Throws
/// UsageError and Error.
int generate_scene(SceneJob& job, const Settings& settings);

}  // namespace vantage::apps
