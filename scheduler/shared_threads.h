#pragma once

#include <chrono>
#include <condition_variable>
#include <list>
#include <memory>
#include <mutex>
#include <optional>

#include "scheduler/executor.h"

namespace vantage::scheduler {

/// Divides the threads of an executor among calls that several threads make at once, so that no
/// more threads work than the executor has. A call waits until one of them is free, in the order of
/// arrival. Its loops also use threads that no other call needs.
class SharedThreads {
 public:
  /// `thread_count` ≥ 1.
  explicit SharedThreads(int thread_count) : thread_count_(thread_count), free_(thread_count) {}
  SharedThreads(const SharedThreads&) = delete;
  SharedThreads& operator=(const SharedThreads&) = delete;

  /// While it lives, the thread that made it counts as one of the executor's threads. The
  /// constructor waits for a free one; an InterruptibleScope ends the wait with Interrupted. A call
  /// inside another one of the same thread has no effect. Destroyed by the thread that made it.
  class Call {
   public:
    explicit Call(SharedThreads& threads);
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;
    ~Call();

   private:
    SharedThreads& threads_;
    SharedThreads* outer_;  ///< what the thread shared before
  };

 private:
  friend class SharingExecutor;

  struct Waiter {
    bool has_thread = false;
    std::condition_variable admitted;
  };

  void enter();
  void leave();
  /// For a loop of a call: takes up to `wanted` threads beside the call's own, returns how many.
  int take_helpers(int wanted);
  void give_back(int threads);
  /// Gives free threads to waiting calls. `mutex_` is held.
  void admit();

  const int thread_count_;
  std::mutex mutex_;
  std::list<Waiter> waiting_;  ///< calls in order of arrival
  int free_;
  int calls_ = 0;  ///< that have a thread
  /// When the last call ended; unset after a call has begun.
  std::optional<std::chrono::steady_clock::time_point> ended_;
};

/// An executor that works like `inner`. Its loops inside a SharedThreads::Call of `threads` use
/// threads of that call; all others use all threads of `inner`. `threads` must outlive it.
std::unique_ptr<Executor> sharing(std::unique_ptr<Executor> inner, SharedThreads& threads);

}  // namespace vantage::scheduler
