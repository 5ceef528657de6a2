#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/jobs/sequence_views.h"
#include "engine/options/match_settings.h"
#include "engine/options/rig_scale.h"
#include "engine/options/settings.h"
#include "engine/rectification/rectified_pair.h"
#include "engine/rectification/rows/row_correction.h"
#include "engine/sequence/options/sequence_options.h"
#include "engine/sequence/pairs/pair_source.h"
#include "engine/sequence/work_plan.h"

namespace vantage {

/// What is computed of which pairs, wherever the results go.
struct SequenceJob {
  SequenceJob() {
    sequence.match = options_with_found_range();
    input.masks = {};
  }

  PairSourceOptions input;
  std::string calibration;  ///< file, empty = rectified pairs
  std::string unrectified;  ///< file of cameras of photographs that are not rectified
  bool rectified_pixels = false;
  CalibrationChoice calibration_choice;  ///< of calibrations of the run and of a list
  RectificationOptions rectification;
  RowMode rows = RowMode::kAuto;  ///< kAuto: sequence.rows is found, unless it is known
  RigScale rig;                   ///< of depths
  std::string poses;  ///< file of a trajectory; empty: points are in the frame of the camera
  SequenceOptions sequence;
  /// Empty: the disparity map, and the views if there are any.
  std::optional<std::vector<SequenceOutput>> save;
  SequenceViews views;
  /// Sets sequence.search_scope. Empty: kShot for depth videos and comfort if no range is given and
  /// frames are independent, else kFilm.
  std::optional<SearchScope> search_scope;
  std::optional<FrameRange> frames;   ///< of the input
  std::optional<int> step_of_frames;  ///< N of --frames A-B:N
  std::optional<int> in_flight;       ///< 1..64; empty: from threads and memory
  bool keep_going = false;

  /// The file of the cameras, empty: none.
  [[nodiscard]] const std::string& cameras_file() const {
    return unrectified.empty() ? calibration : unrectified;
  }
};

/// Outputs by their names, separated by commas, and their names. Throws UsageError.
std::vector<SequenceOutput> to_outputs(const SettingValue& value);
SettingValue output_names(const std::vector<SequenceOutput>& outputs);

/// `rows`, of a sequence. As a value for journals it is also the fields found, one array for each
/// key: pair, width, height, coefficients in pixels.
void add_sequence_rows_setting(Settings& settings, SequenceJob& job);
// Options of it. The first has a group of its own, as has add_steadiness_settings(); the others go
// to the present group.
void add_input_settings(Settings& settings, SequenceJob& job);
Setting& add_save_setting(Settings& settings, SequenceJob& job);
/// New views and the stereo output.
void add_picture_settings(Settings& settings, SequenceJob& job);
void add_poses_setting(Settings& settings, SequenceJob& job);
void add_steadiness_settings(Settings& settings, SequenceJob& job);
void add_chunk_frames_setting(Settings& settings, SequenceJob& job);
void add_in_flight_setting(Settings& settings, SequenceJob& job);
void add_live_setting(Settings& settings, SequenceJob& job);

/// Fills in the fields of `job.sequence` that follow from other fields; poses must have been read.
/// `is_streamed`: frames cannot be looked at before the run. Throws UsageError for invalid fields.
void complete_sequence(SequenceJob& job, bool is_streamed);

/// The values in force by option, for rules that concern several.
OptionValues values_of(const SequenceJob& job, const Settings& settings);

/// Throws UsageError for other invalid fields, combinations and options without effect; applies N
/// of --frames A-B:N.
void check_sequence(SequenceJob& job, const Settings& settings);

}  // namespace vantage
