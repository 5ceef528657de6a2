#pragma once

#include <string>

#include "apps/match/view_output.h"
#include "apps/scene/wanted_scene_views.h"
#include "apps/settings/common_options.h"
#include "engine/options/settings.h"
#include "engine/synthesis/view_synthesizer.h"

namespace vantage::apps {

/// What `scene view` is asked for.
struct SceneViewJob {
  std::string scene;
  WantedSceneViews views;
  ViewOutputOptions output;
  SynthesisOptions synthesis;
  int sources = 4;  ///< photographs that a view of a scene with poses is blended from
  CommonOptions common;
};

/// Renders the views that are wanted, until Ctrl-C, and tells which are outside the scene. Returns
/// the exit code. Throws UsageError and Error.
int run_scene_view(const SceneViewJob& job, const Settings& settings);

}  // namespace vantage::apps
