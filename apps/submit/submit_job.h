#pragma once

#include "apps/run/run_settings.h"
#include "apps/submit/slurm_scripts.h"
#include "engine/options/settings.h"

namespace vantage::apps {

enum class BatchEngine { kSlurm };

/// What `submit` is asked for.
struct SubmitJob {
  RunJob run;
  SlurmOptions slurm;
  BatchEngine engine = BatchEngine::kSlurm;
  bool no_submit = false;
};

/// Writes the job scripts and hands them to Slurm, unless they are only to be written. Returns the
/// exit code. Throws UsageError and Error.
int run_submit(SubmitJob& job, const Settings& settings);

}  // namespace vantage::apps
