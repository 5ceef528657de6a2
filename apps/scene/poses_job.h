#pragma once

#include <optional>
#include <string>

#include "apps/settings/common_options.h"
#include "engine/image/photograph_reading.h"
#include "engine/options/settings.h"
#include "engine/pose_estimation/camera_estimation.h"

namespace vantage::apps {

/// The distance of two cameras, by the numbers of their images.
struct KnownDistance {
  int first = 0;
  int second = 0;
  double metres = 1;
};

/// What `scene poses` is asked for.
struct ScenePosesJob {
  std::string images;
  std::string intrinsics;
  std::optional<LensKind> lens;  ///< of the file of intrinsics
  std::string output;
  bool overwrite = false;
  std::optional<KnownDistance> distance;
  CameraEstimationOptions estimation;
  PhotographReading reading;
  CommonOptions common;
};

/// Estimates the cameras, writes them as a COLMAP model, and tells what is left out and which
/// images 'scene build' could not join. Returns the exit code: kExitSkipped if an image has no
/// pose. Throws UsageError and Error.
int estimate_poses(ScenePosesJob& job, const Settings& settings);

}  // namespace vantage::apps
