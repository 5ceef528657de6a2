#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "apps/submit/array_job.h"
#include "apps/submit/submit_options.h"

namespace vantage::apps {

/// An engine that runs the tasks of a manifest. Limits that an engine does not have are usual ones.
struct EngineEntry {
  BatchEngine engine;
  std::string_view name;
  std::string_view program;  ///< that submits; empty: none, tasks are children of this process
  bool shares_files = true;  ///< tasks see the paths of this machine
  int max_tasks = 100000;
  int max_retries = 1000;
  int drain_s = 120;  ///< time that a task has to end, unless the user says otherwise
  std::vector<std::string_view> options;        ///< that not all engines read
  std::vector<std::string_view> required = {};  ///< of these
  /// Pure. Throws UsageError for what the engine does not take.
  Submission (*write)(const ArrayJob& job, const SubmitOptions& options);
};

/// In the order of BatchEngine.
std::span<const EngineEntry> engines();
const EngineEntry& engine_entry(BatchEngine engine);

/// Throws UsageError for an option that the chosen engine does not read, or lacks.
void check_engine_options(const Settings& settings, const EngineEntry& engine);

Submission slurm_submission(const ArrayJob& job, const SubmitOptions& options);
Submission sge_submission(const ArrayJob& job, const SubmitOptions& options);
Submission kubernetes_submission(const ArrayJob& job, const SubmitOptions& options);
Submission aws_batch_submission(const ArrayJob& job, const SubmitOptions& options);
Submission local_submission(const ArrayJob& job, const SubmitOptions& options);

}  // namespace vantage::apps
