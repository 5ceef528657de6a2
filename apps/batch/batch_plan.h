#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "apps/batch/batch_settings.h"
#include "apps/batch/item_cost.h"
#include "apps/batch/manifest.h"
#include "engine/io/store/object_store.h"
#include "engine/options/settings.h"
#include "engine/sequence/work_plan.h"

namespace vantage::apps {

/// Work that a worker takes at once: pairs that go through one run, or items one after the other,
/// or a part of one.
struct PlannedJob {
  std::vector<int> items = {};                ///< of the manifest, counted from 0
  bool is_list = false;                       ///< they are pairs of one list
  std::optional<Shard> shard = std::nullopt;  ///< of the only item
  double core_seconds = 0;
  std::size_t memory_bytes = 0;
};

/// What all workers of a batch agree on.
struct BatchPlan {
  std::string manifest;  ///< size and checksum of its file
  SettingValue options;  ///< that hold for all items
  std::vector<PlannedJob> jobs;
  /// Of the batch, as far as it is known.
  int frames = 0;
  double core_seconds = 0;
  double gigabytes_in = 0;
  double gigabytes_out = 0;
  std::vector<std::string> problems;  ///< items that cannot be opened now, a line each
};

/// Plans jobs that take about BatchJob::job_seconds on the threads of one. Throws UsageError for an
/// item with invalid options. `progress` is told how many items are done.
BatchPlan make_plan(const BatchJob& batch, const std::vector<ManifestItem>& items,
                    const SettingValue& options, const std::function<void(int)>& progress);

/// JSON text and back, without the totals and problems. The second throws Error.
std::string to_json(const BatchPlan& plan);
BatchPlan plan_from_json(const std::string& text, const std::string& name);

}  // namespace vantage::apps
