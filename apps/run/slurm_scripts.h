#pragma once

#include <filesystem>
#include <string>

#include "apps/run/slurm_options.h"

namespace vantage::apps {

/// What job scripts need to know about the run, besides SlurmOptions.
struct SlurmRun {
  std::filesystem::path folder;    ///< absolute
  std::string program;             ///< absolute path of vantage on the nodes
  bool threads_from_slurm = true;  ///< as many as the task has processors
  /// Name of the journals' parts before "2-of-7": "" or, for some frames, "frames-100-199-".
  std::string part_prefix;
};

/// The files that a run on a cluster needs beside those of the run itself, in DIR/.vantage/slurm:
///   submit.toml, job.toml  all settings of the submission, and of the run in its tasks
///   array.sh, merge.sh     the job array and the job after it
///   task-1.log …           what the tasks and the merge printed, of all attempts
///   failures-JOB_TASK      a line for each failed attempt
///   report-1.json …        --report of the tasks
///   submitted.json         the ids of the jobs
std::filesystem::path slurm_folder(const std::filesystem::path& run_folder);

/// The job array: task i processes shard i. A task near its time limit finishes the frames in
/// flight and is queued again; a failed task is retried up to `retries` times.
std::string array_script(const SlurmOptions& options, const SlurmRun& run);
/// The job that checks the run and joins its videos.
std::string merge_script(const SlurmOptions& options, const SlurmRun& run);

/// Throws UsageError when job scripts cannot hold the path of the run's folder.
void require_folder_for_scripts(const std::filesystem::path& run_folder);

}  // namespace vantage::apps
