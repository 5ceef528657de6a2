#pragma once

#include "engine/execution.h"
#include "engine/options/settings.h"

namespace vantage {

/// Whether pairs are matched: only then there are strips, bands and passes.
enum class Work { kWithMatching, kWithoutMatching };

/// Threads and how they divide the work, which never changes a result.
void add_execution_settings(Settings& settings, ExecutionOptions& execution,
                            Work work = Work::kWithMatching);

}  // namespace vantage
