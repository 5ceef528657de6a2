#pragma once

#include "apps/submit/array_job.h"
#include "apps/submit/submit_job.h"
#include "engine/options/settings.h"

namespace vantage::apps {

/// Sets the tasks of `array`, and the processors, memory and time that the options leave open, by
/// the plan of the batch; a plan is made, and printed unless quiet, only where these need it. Sets
/// the threads of the batch. Throws Error, UsageError where the manifest or an item is not as it
/// must be.
void plan_requests(SubmitJob& job, const Settings& settings, ArrayJob& array);

}  // namespace vantage::apps
