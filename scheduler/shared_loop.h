#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <optional>
#include <vector>

#include "scheduler/task_ranges.h"

namespace vantage::scheduler {

/// A loop that threads of several arenas or teams work on. Who has begun it waits for tasks that
/// somebody has taken, never for threads that have not come yet: so loops within loops cannot wait
/// for each other in a circle.
class SharedLoop {
 public:
  /// `body` is used as long as tasks are left; see wait().
  SharedLoop(int task_count, const std::vector<int>& threads_of_nodes,
             const std::function<void(int task)>& body);

  /// Concurrently, by threads that want to help: a task to run(), if any is left.
  std::optional<int> take(int node) { return tasks_.take(node); }
  /// Runs a task that was taken. Its exception is kept if it is the first, and drops the tasks that
  /// nobody has taken.
  void run(int task);

  /// Returns when all tasks are done or dropped; rethrows the first exception.
  void wait();

 private:
  void count_off(int tasks);

  TaskRanges tasks_;
  const std::function<void(int)>& body_;
  std::atomic<int> unfinished_;
  std::atomic<bool> failed_{false};
  std::exception_ptr error_;  // written by who has set failed_
};

}  // namespace vantage::scheduler
