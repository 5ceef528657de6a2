#pragma once

#include <optional>
#include <string>

#include "apps/scene/scene_images.h"
#include "apps/settings/common_options.h"
#include "engine/image/photograph_reading.h"
#include "engine/matching/options/match_options.h"
#include "engine/options/match_settings.h"
#include "engine/options/settings.h"
#include "engine/rectification/rows/row_correction.h"
#include "engine/scene_graph/edge_maps.h"

namespace vantage::apps {

/// What `scene build` is asked for.
struct SceneBuildJob {
  SceneImagesInput images;
  MatchOptions match = options_with_found_range();
  CommonOptions common;
  std::string output;
  bool overwrite = false;
  bool copy_images = false;
  bool check_rectification = true;
  RowMode rows = RowMode::kAuto;
  std::optional<double> white_level;
  PhotographReading reading;
  int neighbours = SceneBuildOptions{}.neighbours;
};

/// Matches the edges that are not finished, until Ctrl-C, and says what was refused. Returns the
/// exit code. Throws UsageError and Error.
int run_scene_build(const SceneBuildJob& job, const Settings& settings);

}  // namespace vantage::apps
