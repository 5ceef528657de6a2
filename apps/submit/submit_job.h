#pragma once

#include "apps/batch/batch_settings.h"
#include "apps/submit/submit_options.h"
#include "engine/options/settings.h"

namespace vantage::apps {

/// What `submit` is asked for: all items of a manifest, or one run that is divided.
struct SubmitJob {
  BatchJob batch;  ///< without a manifest: its `run` alone
  SubmitOptions options;
};

/// Writes the scripts of a run's shards for Slurm and, with --go, submits them. Returns the exit
/// code. Throws UsageError and Error.
int submit_divided_run(SubmitJob& job, const Settings& settings);

/// Writes what the engine takes for the items of a manifest and, with --go, submits it; waits for
/// workers on this machine. Returns the exit code. Throws UsageError and Error.
int submit_manifest(SubmitJob& job, const Settings& settings);

}  // namespace vantage::apps
