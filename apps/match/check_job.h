#pragma once

#include <string>

#include "apps/settings/common_options.h"
#include "engine/jobs/sequence_job.h"
#include "engine/options/settings.h"

namespace vantage::apps {

/// What `check` is asked for. `right` is empty for pictures that hold both images.
struct CheckJob : SequenceJob {
  std::string left;
  std::string right;
  CommonOptions common;
};

/// Examines the pair, or some pairs of a sequence, prints what they are like and the command to
/// type. Returns kExitFailed where no match makes sense. Throws UsageError and Error.
int run_check(CheckJob& job, const Settings& settings);

}  // namespace vantage::apps
