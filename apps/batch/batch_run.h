#pragma once

#include "apps/batch/batch_settings.h"
#include "engine/options/settings.h"

namespace vantage::apps {

/// Exit code of a worker that ended before its share was done: start it again.
inline constexpr int kExitTryAgain = 75;  // EX_TEMPFAIL of sysexits.h

/// Plans and works, as `job` says. Returns the exit code. Throws Error, UsageError.
int run_batch(BatchJob& job, const Settings& settings);

}  // namespace vantage::apps
