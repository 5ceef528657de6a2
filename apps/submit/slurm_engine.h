#pragma once

#include <string>

#include "apps/submit/array_job.h"
#include "apps/submit/submit_options.h"
#include "apps/submit/task_script.h"

namespace vantage::apps {

/// The job array. A task near its time limit ends and is queued again.
std::string slurm_array_script(const ArrayJob& job, const SubmitOptions& options,
                               const TaskWork& work);
/// A job of its own: `command`, a line of bash, with the log `name`.log.
std::string slurm_job_script(const ArrayJob& job, const SubmitOptions& options,
                             const std::string& name, const std::string& command);

/// Throws UsageError when the directives of a script cannot hold the path of its folder.
void require_folder_for_slurm(const std::filesystem::path& folder);

}  // namespace vantage::apps
