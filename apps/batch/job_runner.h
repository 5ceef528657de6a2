#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/batch/batch_item.h"
#include "apps/batch/batch_plan.h"
#include "apps/batch/child_run.h"
#include "apps/batch/item_result.h"
#include "apps/batch/manifest.h"
#include "engine/io/store/object_store.h"

namespace vantage::apps {

/// Does the jobs of a batch: each is one or more runs of this program as children, so that what
/// ends a run does not end the batch. Runs of a batch in a folder write there; others work in a
/// scratch folder, and their results are kept in the store as they are made. Thread rule: one
/// thread at a time.
class JobRunner {
 public:
  /// All must outlive it. `options` hold for all items; `store` is that of the batch; `scratch` is
  /// a folder of this machine: for a batch in a folder, within that. Once `stop` is set, children
  /// finish their frames, and are killed where that takes too long.
  JobRunner(const BatchJob& batch, const std::vector<ManifestItem>& items,
            const SettingValue& options, ObjectStore& store, std::filesystem::path scratch,
            const std::atomic<bool>& stop);

  /// Adds the results of the items of `job` to `known`, which has those that are done, and tells
  /// `on_results` when some are new. Fewer when `stop` was set. Throws Error where the results
  /// cannot be written.
  void run(const PlannedJob& job, const std::string& name, std::vector<ItemResult>& known,
           const std::function<void()>& on_results);
  /// Joins the parts of an item, all of which are done. Empty when `stop` was set.
  std::optional<ItemResult> join(int item, const std::string& name);

 private:
  [[nodiscard]] bool is_stopped() const { return stop_.load(); }
  std::optional<ItemResult> run_item(int index, const std::optional<Shard>& shard,
                                     const std::filesystem::path& work);
  ChildEnding run_in_scratch(const RunJob& job, const std::string& output,
                             const std::vector<std::string>& words,
                             const std::filesystem::path& work);
  void run_list(const std::vector<int>& items, const std::filesystem::path& work,
                std::vector<ItemResult>& results);
  void take_list_results(const std::vector<int>& items, const RunJob& run,
                         const ChildEnding& ending, std::vector<ItemResult>& results);
  /// Gives a file its final place. Throws Error where another file is there.
  void deliver(const std::filesystem::path& from, const std::string& name,
               const FileContent& content);
  ItemResult failed(int item, const ChildEnding& ending);
  [[nodiscard]] BatchItem item(int index) const {
    return {items_[static_cast<std::size_t>(index)], batch_, options_};
  }
  [[nodiscard]] const std::string& output_of(int index) const {
    return items_[static_cast<std::size_t>(index)].output;
  }

  const BatchJob& batch_;
  const std::vector<ManifestItem>& items_;
  const SettingValue& options_;
  ObjectStore& store_;
  std::filesystem::path scratch_;
  const std::atomic<bool>& stop_;
  bool is_remote_;
  ChildRuns children_;
};

}  // namespace vantage::apps
