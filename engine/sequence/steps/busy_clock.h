#pragma once

#include <chrono>
#include <mutex>

namespace vantage {

/// Measures the time during which at least one of several overlapping activities is running. Thread
/// rule: all members may be called concurrently.
class BusyClock {
 public:
  /// An activity: from construction to destruction.
  class Activity {
   public:
    explicit Activity(BusyClock& clock) : clock_(clock) { clock_.begin(); }
    Activity(const Activity&) = delete;
    Activity& operator=(const Activity&) = delete;
    ~Activity() { clock_.end(); }

   private:
    BusyClock& clock_;
  };

  /// Total of all ended activities; call it when none is running.
  [[nodiscard]] double seconds() const {
    const std::lock_guard lock(mutex_);
    return std::chrono::duration<double>(busy_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;

  void begin() {
    const std::lock_guard lock(mutex_);
    if (active_++ == 0) {
      since_ = Clock::now();
    }
  }
  void end() {
    const std::lock_guard lock(mutex_);
    if (--active_ == 0) {
      busy_ += Clock::now() - since_;
    }
  }

  mutable std::mutex mutex_;
  int active_ = 0;
  Clock::time_point since_;
  Clock::duration busy_{};
};

}  // namespace vantage
