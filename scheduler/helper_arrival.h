#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <limits>

namespace vantage::scheduler {

/// Moves the calling thread to another core if it may run on several; returns whether it moved.
bool leave_core();

/// Same, unless more threads of the machine want to run than there are cores for this one.
bool move_to_idle_core();

/// Makes room for the threads that a loop wakes after a pause. Linux may queue them on the core of
/// the thread that woke them, even if another one is idle, and move them some milliseconds later:
/// both maps of a small pair take no longer. If no helper has come a moment after the first loop
/// has started, its caller moves to an idle core, once. Thread rule: any thread.
class HelperArrival {
 public:
  /// Moves the calling thread; returns whether it did.
  using Move = bool (*)();

  /// pause: after shorter ones helpers still look for work, or are woken where they ran before.
  /// patience: helpers on other cores come sooner, even where idle cores sleep deeply.
  explicit HelperArrival(std::chrono::microseconds pause = std::chrono::microseconds(2000),
                         std::chrono::microseconds patience = std::chrono::microseconds(200),
                         Move move = move_to_idle_core)
      : pause_(pause), patience_(patience), move_(move) {}

  /// Marks that an executor works, from before a loop starts until it has ended.
  class Work {
   public:
    /// wakes_helpers: whether the calling thread is about to start a loop with tasks for others.
    Work(HelperArrival& arrival, bool wakes_helpers);
    Work(const Work&) = delete;
    Work& operator=(const Work&) = delete;
    ~Work();

   private:
    HelperArrival& arrival_;
  };

  /// To be called by each thread after each task. Returns whether the thread moved.
  bool note_task() { return is_awaited_.load(std::memory_order_relaxed) && look(); }

 private:
  bool look();

  std::chrono::nanoseconds pause_;
  std::chrono::nanoseconds patience_;
  Move move_;
  std::atomic<int> works_{0};
  std::atomic<std::int64_t> end_ns_{std::numeric_limits<std::int64_t>::min() / 2};
  std::atomic<bool> is_awaited_{false};
  // Of the work that awaits helpers.
  std::atomic<std::int64_t> start_ns_{0};
  std::atomic<const void*> caller_{nullptr};
};

}  // namespace vantage::scheduler
