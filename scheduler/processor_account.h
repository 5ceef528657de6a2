#pragma once

#include <atomic>
#include <cstdint>

namespace vantage::scheduler {

/// Processor time of one kind of work, over all threads. Thread rule: seconds() from any thread;
/// charges that have not ended are not in it.
class ProcessorAccount {
 public:
  [[nodiscard]] double seconds() const {
    return 1e-9 * static_cast<double>(time_ns_.load(std::memory_order_relaxed));
  }

 private:
  friend class ProcessorCharge;
  std::atomic<std::int64_t> time_ns_{0};
};

/// From construction to destruction, the processor time of this thread is charged to an account,
/// and so is that of the tasks of loops that start meanwhile (executors of make_executor()). Within
/// an inner charge, such as that of another frame's step while this thread waits in a loop, only
/// the inner account is charged.
class ProcessorCharge {
 public:
  /// Null charges nothing. `account` must outlive the charge.
  explicit ProcessorCharge(ProcessorAccount* account);
  ProcessorCharge(const ProcessorCharge&) = delete;
  ProcessorCharge& operator=(const ProcessorCharge&) = delete;
  ~ProcessorCharge();

  /// The account charged now; null if there is none.
  [[nodiscard]] static ProcessorAccount* account_in_use();

 private:
  static void change_to(ProcessorAccount* account);

  ProcessorAccount* outer_;
};

}  // namespace vantage::scheduler
