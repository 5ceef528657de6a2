#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "apps/run/run_settings.h"
#include "engine/options/settings.h"

namespace vantage::apps {

/// A task of a job array, which does the jobs index − 1, index − 1 + count and so on.
struct ArrayTask {
  int index = 1;  ///< 1..count
  int count = 1;
};

/// Everything a user can set about a batch.
struct BatchJob {
  std::string manifest;
  RunJob run;                     ///< what holds for all items; its output is that of the batch
  double job_seconds = 20 * 60;   ///< time that a job should take, 1 s to a week
  std::optional<ArrayTask> task;  ///< of the jobs of a task alone
  bool worker = false;            ///< joins what is there
  bool retry_failed = false;
  double grace_seconds = 90;  ///< from a signal until work is handed back, 1 s to a day
  double lease_seconds = 60;  ///< a worker that shows no sign for so long is gone, 2 s to a day
  int attempts = 3;           ///< of an item that fails, 1..100
  std::string scratch;        ///< folder of this machine; empty: that of temporary files
  std::optional<std::size_t> scratch_limit_bytes;
  double keep_seconds = 60;  ///< between two times that results are put into a store, 1 s to a day
  std::string metrics;       ///< file for Prometheus; empty: none
};

/// Binds all fields of `job`: the options of 'vantage batch'.
void add_batch_settings(Settings& settings, BatchJob& job);

/// Of these, how items become jobs and what workers need: what `submit` hands on.
void add_job_settings(Settings& settings, BatchJob& job);

/// Throws UsageError for invalid fields, and for options of run that have no sense for all items.
void check_batch(const BatchJob& job, const Settings& settings);

}  // namespace vantage::apps
