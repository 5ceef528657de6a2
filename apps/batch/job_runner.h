#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/batch/batch_item.h"
#include "apps/batch/batch_plan.h"
#include "apps/batch/item_result.h"
#include "apps/batch/manifest.h"

namespace vantage::apps {

/// Does the jobs of a batch: each is one or more runs of this program as children, so that what
/// ends a run does not end the batch. Thread rule: one thread at a time.
class JobRunner {
 public:
  /// All must outlive it. `options` hold for all items. Once `stop` is set, children finish their
  /// frames, and are killed where that takes too long.
  JobRunner(const BatchJob& batch, const std::vector<ManifestItem>& items,
            const SettingValue& options, const std::atomic<bool>& stop);

  /// The results of all items of `job`, except those of `known`. Pairs are all told at the end,
  /// others after each one, by `on_results`. Fewer when `stop` was set. Throws Error where the
  /// folder of the batch cannot be written.
  void run(const PlannedJob& job, const std::string& name, std::vector<ItemResult>& known,
           const std::function<void()>& on_results);
  /// Joins the parts of an item, all of which are done. Empty when `stop` was set.
  std::optional<ItemResult> merge(int item);

 private:
  /// How a child ended.
  struct Ending {
    int exit_code = 0;
    std::string problem = {};   ///< its last message
    SettingValue results = {};  ///< of its report; null: there is none
    int attempts = 1;
    double seconds = 0;
  };
  [[nodiscard]] bool is_stopped() const { return stop_.load(); }
  [[nodiscard]] Ending run_child(const std::vector<std::string>& words,
                                 const std::filesystem::path& report) const;
  [[nodiscard]] Ending try_child(const std::vector<std::string>& words,
                                 const std::filesystem::path& report) const;
  [[nodiscard]] std::optional<ItemResult> run_item(int index, const std::optional<Shard>& shard,
                                                   const std::filesystem::path& work) const;
  /// Empty where the child did not get to its end because `stop` was set.
  [[nodiscard]] std::optional<ItemResult> result_of(int index, const Ending& ending) const;
  void run_list(const std::vector<int>& items, const std::filesystem::path& work,
                std::vector<ItemResult>& results) const;
  void take_list_results(const std::vector<int>& items, const RunJob& run, const Ending& ending,
                         std::vector<ItemResult>& results) const;
  [[nodiscard]] ItemResult failed(int item, const Ending& ending) const;
  [[nodiscard]] ItemResult done(int item, const Ending& ending) const;
  [[nodiscard]] BatchItem item(int index) const {
    return {items_[static_cast<std::size_t>(index)], batch_, options_};
  }

  const BatchJob& batch_;
  const std::vector<ManifestItem>& items_;
  const SettingValue& options_;
  const std::atomic<bool>& stop_;
  std::filesystem::path state_;  ///< folder of the batch's own files
  std::string program_;
};

}  // namespace vantage::apps
