#pragma once

#include <optional>
#include <string>

#include "apps/inputs/rectification_check.h"
#include "apps/process/outputs.h"
#include "apps/reports/run_report.h"
#include "apps/settings/common_options.h"
#include "engine/execution.h"
#include "engine/image/photograph_reading.h"
#include "engine/io/images/scene_mask.h"
#include "engine/matching/options/match_options.h"
#include "engine/options/given_map_settings.h"
#include "engine/options/match_settings.h"
#include "engine/options/rig_scale.h"
#include "engine/options/settings.h"
#include "engine/rectification/rectified_pair.h"
#include "engine/synthesis/pair_with_maps.h"

namespace vantage::apps {

/// A pair of a command that makes views: two files, and two more with their disparity
/// maps unless the pair is to be matched.
struct PairInput {
  std::string left;
  std::string right;
  std::string left_disparity;  ///< empty, as the next: matched
  std::string right_disparity;
  GivenMapOptions given;
  std::string calibration;  ///< file, empty = a rectified pair of which nothing is known
  RigScale rig;             ///< of given depths
  CalibrationChoice calibration_choice;
  RectificationOptions rectification;
  MatchOptions match = options_with_found_range();
  std::optional<double> white_level;  ///< empty: see WhiteLevelSearch
  PhotographReading reading;
  RowSettings rows;
  SceneMaskOptions masks;

  [[nodiscard]] bool has_maps() const { return !left_disparity.empty(); }
};

/// Where one file of a stereo camera (MPO, JPS) stands for a pair, `right` being empty, names its
/// views FILE#0 and FILE#1. Throws UsageError where the right image is missing.
void name_views(std::string& left, std::string& right);

/// LEFT, RIGHT, and the options of the calibration and of maps in files, in the group that has
/// begun. Options of matching are not among them (add_match_settings).
void add_pair_settings(Settings& settings, PairInput& pair);

/// Throws UsageError when the options do not go together, or when options of matching are on the
/// command line beside maps, where they would have no effect. Adds the files to `files`.
void check_pair(const PairInput& pair, const Settings& settings);

/// What the report says of the settings of a command with such a pair.
SettingValue reported_settings(const Settings& settings, const PairInput& pair);

/// Reads the images, rectifies them if the calibration says so, and reads or makes the maps. Where
/// --disparities is auto, `pair` then has the range found. Throws Error and UsageError as reading
/// and matching do.
PairWithMaps read_pair(PairInput& pair, const Settings& settings, const CommonOptions& common,
                       Execution& execution, RunReport& report);

}  // namespace vantage::apps
