#pragma once

#include <filesystem>
#include <string>

#include "apps/submit/slurm_options.h"

namespace vantage::apps {

/// What job scripts need to know about the run, besides SlurmOptions.
struct SlurmRun {
  std::filesystem::path folder;    ///< absolute
  std::string program;             ///< absolute path of vantage on the nodes
  bool threads_from_slurm = true;  ///< as many as the task has processors
  /// Name of the journals' parts before "2-of-7": "" or, for some frames, "frames-100-199-".
  std::string part_prefix;
};

/// The job array: task i processes shard i. A task near its time limit finishes the frames in
/// flight and is queued again; a failed task is retried up to `retries` times.
std::string array_script(const SlurmOptions& options, const SlurmRun& run);
/// The job that checks the run and joins its videos.
std::string merge_script(const SlurmOptions& options, const SlurmRun& run);

/// Throws UsageError when job scripts cannot hold the path of the run's folder.
void require_folder_for_scripts(const std::filesystem::path& run_folder);

}  // namespace vantage::apps
