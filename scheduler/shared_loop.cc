#include "scheduler/shared_loop.h"

#include <utility>

namespace vantage::scheduler {

SharedLoop::SharedLoop(int task_count, const std::vector<int>& threads_of_nodes,
                       const std::function<void(int)>& body)
    : tasks_(task_count, threads_of_nodes), body_(body), unfinished_(task_count) {}

void SharedLoop::run(int task) {
  int finished = 1;
  try {
    body_(task);
  } catch (...) {
    if (!failed_.exchange(true)) {
      error_ = std::current_exception();
    }
    finished += tasks_.take_all();
  }
  count_off(finished);
}

void SharedLoop::count_off(int tasks) {
  if (unfinished_.fetch_sub(tasks) == tasks) {
    unfinished_.notify_all();
  }
}

void SharedLoop::wait() {
  for (int left = unfinished_.load(); left != 0; left = unfinished_.load()) {
    unfinished_.wait(left);
  }
  // Helpers may outlive the caller's interest in the loop, but not in its exception.
  if (const std::exception_ptr error = std::exchange(error_, nullptr)) {
    std::rethrow_exception(error);
  }
}

}  // namespace vantage::scheduler
