#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "apps/batch/batch_state.h"
#include "apps/batch/job_runner.h"
#include "engine/io/store/lease.h"

namespace vantage::apps {

/// How a worker's share ended.
struct WorkerEnding {
  bool interrupted = false;  ///< what was begun is handed back
  bool all_done = false;     ///< all jobs of the batch, also those of others
};

/// One of the workers of a batch: takes jobs until none is left, or those of a task of an array.
/// Whoever finds all parts of an item done joins them. Where another worker holds what is left, it
/// waits: that one may die. Thread rule: one thread at a time.
class BatchWorker {
 public:
  using OnJob = std::function<void(const std::string& name, const std::vector<ItemResult>&)>;
  /// All must outlive it. `on_job` is told each job that this worker has done.
  BatchWorker(const BatchJob& batch, const BatchPlan& plan, BatchState& state, Leases& leases,
              JobRunner& runner, const std::atomic<bool>& stop, OnJob on_job);

  /// Throws Error where the state of the batch cannot be read or written.
  WorkerEnding run();
  /// Jobs that are done, of all workers, as far as known.
  [[nodiscard]] const std::set<std::string>& done() const { return done_; }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

 private:
  enum class Pass { kWorked, kNothingFree, kNothingLeft };
  Pass pass();
  void do_job(Lease& lease);
  /// Empty where `stop` was set.
  std::vector<ItemResult> join_parts(const std::string& name);
  /// Of an item that is divided: whether this one may be joined now, by this worker.
  [[nodiscard]] bool is_ready(const std::string& name) const;
  [[nodiscard]] bool is_own(const std::string& name) const;
  void wait() const;

  const BatchJob& batch_;
  const BatchPlan& plan_;
  BatchState& state_;
  Leases& leases_;
  JobRunner& runner_;
  const std::atomic<bool>& stop_;
  OnJob on_job_;
  std::vector<std::string> names_;                         ///< of all jobs, joining included
  std::map<std::string, std::vector<std::string>> parts_;  ///< of items that are joined
  std::map<std::string, std::size_t> job_of_;
  std::set<std::string> done_;
  std::size_t first_;  ///< where this worker begins to look
};

/// The name of the job that joins the parts of an item.
std::string name_of_merge(int item);
std::string name_of_job(std::size_t job);

}  // namespace vantage::apps
