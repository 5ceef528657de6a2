#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "apps/applied_tuning.h"
#include "apps/match_settings.h"
#include "apps/option_groups.h"
#include "apps/outputs.h"
#include "apps/progress.h"
#include "apps/rig_scale.h"
#include "apps/sequence_views.h"
#include "apps/settings.h"
#include "engine/rectification/rectified_pair.h"
#include "engine/sequence/pair_source.h"
#include "engine/sequence/sequence_layout.h"
#include "engine/sequence/sequence_options.h"
#include "engine/sequence/work_plan.h"

namespace vantage::apps {

/// Everything a user can set about a run.
struct RunJob {
  RunJob() { sequence.match = options_with_found_range(); }

  PairSourceOptions input;
  std::string calibration;  ///< file, empty = rectified pairs
  RectificationOptions rectification;
  RigScale rig;        ///< of depths
  std::string poses;   ///< file of a trajectory; empty: points are in the frame of the camera
  std::string output;  ///< folder
  SequenceOptions sequence;
  /// Empty: the disparity map, and the views if there are any.
  std::optional<std::vector<SequenceOutput>> save;
  SequenceViews views;
  /// Of sequence.search_range_per_shot; empty: per shot for depth videos and comfort, if no range
  /// is given and frames are independent.
  std::optional<bool> search_range_per_shot;
  StreamFormat stream_format = StreamFormat::kY4m;  ///< of standard output
  std::optional<FrameRate> frame_rate;              ///< empty: the input's, else 25
  std::optional<FrameRange> frames;                 ///< of the input
  std::optional<int> step_of_frames;                ///< N of --frames A-B:N
  std::optional<Shard> shard;
  std::optional<int> in_flight;  ///< 1..64; empty: from threads and memory
  std::optional<std::size_t> memory_bytes;
  bool dry_run = false;
  bool resume = false;
  bool overwrite = false;
  bool force = false;
  bool keep_going = false;
  bool check_rectification = true;
  ProgressStyle progress = ProgressStyle::kAuto;
  CommonOptions common;
  TuningSource tuning;

  /// `progress`, or none with --quiet.
  [[nodiscard]] ProgressStyle shown_progress() const {
    return common.quiet ? ProgressStyle::kNone : progress;
  }
};

/// Binds all fields of `job`: the options of 'vantage run'.
void add_run_settings(Settings& settings, RunJob& job);

/// Fills in the fields of `job.sequence` that follow from other fields; poses must have been read.
/// Throws UsageError for invalid fields.
void complete_sequence(RunJob& job);

/// Reads the files of poses and completes all fields. Throws UsageError for invalid fields and
/// combinations. Reads no other files.
void complete(RunJob& job, const Settings& settings);

/// Adds to `files` what runs write to the folder of `layout`, which `option` names.
void add_run_outputs(const SequenceLayout& layout, bool has_comfort, const std::string& option,
                     FileChecks& files);
/// All files that a run reads and writes, except the frames, which are unknown before the input is
/// opened.
FileChecks check_files(const RunJob& job, const Settings& settings);

}  // namespace vantage::apps
