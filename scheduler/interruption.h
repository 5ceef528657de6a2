#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <thread>

#include "scheduler/executor.h"

namespace vantage::scheduler {

/// A loop was interrupted, see InterruptibleScope.
class Interrupted : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "interrupted"; }
};

/// During its lifetime, loops that its thread starts on executors of interruptible(), and loops
/// inside their tasks, end early with Interrupted once `is_wanted` returns true. It is called
/// between tasks, by the thread of the scope only, at most every 20 ms. What the loops were to
/// write is then incomplete. A scope inside another one replaces it while it lives.
class InterruptibleScope {
 public:
  explicit InterruptibleScope(std::function<bool()> is_wanted);
  InterruptibleScope(const InterruptibleScope&) = delete;
  InterruptibleScope& operator=(const InterruptibleScope&) = delete;
  ~InterruptibleScope();

  /// Throws Interrupted if that is wanted. Thread rule: any thread.
  void check();
  /// That of the loop that this thread runs a task of, or of this thread; null: none.
  static InterruptibleScope* in_use();

  /// Makes `scope`, which may be null, the one in use of this thread.
  class Use {
   public:
    explicit Use(InterruptibleScope* scope);
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    ~Use();

   private:
    InterruptibleScope* before_;
  };

 private:
  std::function<bool()> is_wanted_;
  std::thread::id thread_ = std::this_thread::get_id();
  std::chrono::steady_clock::time_point next_call_;
  std::atomic<bool> interrupted_ = false;
  Use use_;
};

/// InterruptibleScope::check() of the scope in use, if there is one: for work without loops on
/// executors.
void check_interruption();

/// An executor that works like `inner`, with loops that an InterruptibleScope can end.
std::unique_ptr<Executor> interruptible(std::unique_ptr<Executor> inner);

}  // namespace vantage::scheduler
