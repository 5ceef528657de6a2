#pragma once

#include "apps/match/match_job.h"
#include "engine/options/settings.h"

namespace vantage::apps {

/// The work of 'vantage match': checks the job, finds the range if it is `auto`, matches, writes
/// the files and tells what was made. Returns the exit code. Throws UsageError and Error.
int run_match(MatchJob& job, const Settings& settings);

}  // namespace vantage::apps
