#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "apps/process/outputs.h"
#include "apps/process/progress.h"
#include "apps/settings/applied_tuning.h"
#include "apps/settings/common_options.h"
#include "engine/jobs/sequence_job.h"
#include "engine/options/settings.h"
#include "engine/sequence/options/sequence_layout.h"
#include "engine/sequence/work_plan.h"

namespace vantage::apps {

/// Everything a user can set about a run.
struct RunJob : SequenceJob {
  std::string output;                               ///< folder
  StreamFormat stream_format = StreamFormat::kY4m;  ///< of standard output
  std::optional<FrameRate> frame_rate;              ///< empty: the input's, else 25
  std::optional<Shard> shard;
  std::optional<std::size_t> memory_bytes;
  bool dry_run = false;
  bool show = false;
  bool resume = false;
  bool overwrite = false;
  bool force = false;
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

/// Reads the files of poses and completes all fields. Throws UsageError for invalid fields and
/// combinations. Reads no other files.
void complete(RunJob& job, const Settings& settings);

/// The files that a run on a cluster needs beside those of the run itself, in DIR/.vantage/slurm:
///   submit.toml, job.toml  all settings of the submission, and of the run in its tasks
///   array.sh, merge.sh     the job array and the job after it
///   task-1.log …           what the tasks and the merge printed, of all attempts
///   failures-JOB_TASK      a line for each failed attempt
///   report-1.json …        --report of the tasks
///   submitted.json         the ids of the jobs
std::filesystem::path slurm_folder(const std::filesystem::path& run_folder);

/// Adds to `files` what runs write to the folder of `layout`, which `option` names.
void add_run_outputs(const SequenceLayout& layout, bool has_comfort, const std::string& option,
                     FileChecks& files);
/// All files that a run reads and writes, except the frames, which are unknown before the input is
/// opened.
FileChecks check_files(const RunJob& job, const Settings& settings);

}  // namespace vantage::apps
