#pragma once

#include <string>
#include <vector>

#include "apps/batch/batch_plan.h"
#include "apps/batch/batch_state.h"
#include "apps/batch/manifest.h"

namespace vantage::apps {

/// Results of a batch, or of the share of one worker.
struct BatchTotals {
  int done = 0;  ///< items; of those that are divided, whole ones
  int with_skipped_frames = 0;
  int failed = 0;
  int frames = 0;
  double core_seconds = 0;

  void add(const ItemResult& result);
};

/// What 'vantage batch --dry-run' prints.
std::string describe_plan(const BatchPlan& plan, const BatchJob& batch, std::size_t items);
/// The same as values, for --report.
SettingValue plan_values(const BatchPlan& plan);

/// The result of each item that is done, in the order of the manifest.
std::vector<ItemResult> item_results(const BatchPlan& plan, BatchState& state);
/// A JSON line per item, with its line in the manifest and its output.
std::string item_lines(const std::vector<ManifestItem>& items,
                       const std::vector<ItemResult>& results);
/// Items by status, and those that failed with the command that repeats each.
std::string describe_results(const std::vector<ManifestItem>& items,
                             const std::vector<ItemResult>& results);
/// Text for Prometheus. `jobs_done` of `jobs` are those of the batch, `totals` of this worker.
std::string metrics_text(const BatchTotals& totals, std::size_t jobs_done, std::size_t jobs);

}  // namespace vantage::apps
