#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "apps/submit/array_job.h"

namespace vantage::apps {

/// How many workers of so many processors and so much memory this machine takes at a time: at least
/// 1, at most `limit`.
int workers_that_fit(int cores, std::size_t memory_bytes, std::optional<int> limit);

/// Runs the commands side by side, with a log each in the folder of the job, and waits; after
/// SIGTERM or SIGINT all are told to end. Returns the highest exit code. Throws Error where one
/// cannot be started.
int run_workers(const ArrayJob& job, const std::vector<std::vector<std::string>>& commands);

}  // namespace vantage::apps
