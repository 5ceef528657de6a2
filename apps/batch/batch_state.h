#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "apps/batch/batch_plan.h"
#include "apps/batch/item_result.h"
#include "engine/io/store/object_store.h"

namespace vantage::apps {

/// What the workers of a batch share, as objects below .vantage/batch/ in its store:
///   plan.json                what all agree on
///   probe                    of excludes()
///   leases/NAME/000001 …     who does a job, see Lease
///   progress/NAME.json       results of a job that is not done
///   done/NAME.json           results of a job that is done; it is written once
/// NAME is the number of a job, merge- and the number of an item, or plan. Thread rule: one thread
/// at a time. All functions throw Error where the store does not answer.
class BatchState {
 public:
  static constexpr const char* kPrefix = ".vantage/batch/";

  explicit BatchState(ObjectStore& store) : store_(store) {}

  /// Empty: there is none yet.
  [[nodiscard]] std::optional<BatchPlan> read_plan();
  /// The plan in force: `plan`, unless another worker was first.
  BatchPlan keep_plan(const BatchPlan& plan);

  /// Whether the store refuses to create what is there, on which leases rely.
  bool excludes();

  /// Names of the jobs that are done.
  std::set<std::string> done();
  [[nodiscard]] bool is_done(const std::string& name);
  /// Results of a job: done, else as far as they are known.
  std::vector<ItemResult> results(const std::string& name);
  void keep_progress(const std::string& name, const std::vector<ItemResult>& results);
  /// False where another worker was first; its results stand.
  bool finish(const std::string& name, const std::vector<ItemResult>& results);
  /// Forgets what became of a job, so that it is done again.
  void reopen(const std::string& name);

 private:
  [[nodiscard]] std::optional<std::string> read(const std::string& key);

  ObjectStore& store_;
};

}  // namespace vantage::apps
