#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <optional>
#include <vector>

#include "scheduler/task_ranges.h"

namespace vantage::scheduler {

/// A loop whose tasks are run by threads of several arenas or teams. Its caller waits only for
/// tasks that a thread has taken, never for threads that have not arrived yet. What is waited for
/// was therefore always started later than what waits, and nested loops cannot deadlock.
class SharedLoop {
 public:
  /// `body` must stay valid until wait() has returned.
  SharedLoop(int task_count, const std::vector<int>& threads_of_nodes,
             const std::function<void(int task)>& body);

  /// Called concurrently by helping threads: a task for run(), if any is left.
  std::optional<int> take(int node) { return tasks_.take(node); }
  /// Runs a task that was taken. The first exception is kept, and drops all tasks that have not
  /// been taken.
  void run(int task);

  /// Returns when all tasks are done or dropped; rethrows the first exception.
  void wait();

 private:
  void count_off(int tasks);

  TaskRanges tasks_;
  const std::function<void(int)>& body_;
  std::atomic<int> unfinished_;
  std::atomic<bool> failed_{false};
  std::exception_ptr error_;  // written by the thread that sets failed_
};

}  // namespace vantage::scheduler
