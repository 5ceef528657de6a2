#pragma once

#include <optional>
#include <string>

#include "apps/batch/batch_settings.h"

namespace vantage::apps {

/// "K/N"; empty for any other text.
std::optional<ArrayTask> to_array_task(const std::string& text);

/// The task of a job array that this process is, by the variables of Slurm, AWS Batch, Kubernetes
/// (Indexed Jobs), grid engines and PBS; VANTAGE_BATCH_TASKS is the number of tasks where the
/// engine does not say it. Empty: it is none. Throws UsageError where the number of tasks is
/// unknown, and for values that are no numbers.
std::optional<ArrayTask> task_of_environment();

}  // namespace vantage::apps
