#pragma once

#include <optional>

namespace vantage::scheduler {

/// Measures how much processor time other programs use while this one runs.
///
/// Thread rule: of_others() may be called from any thread.
class ProcessorUse {
 public:
  ProcessorUse();

  /// Mean number of processors that other processes and the system (including a virtual machine's
  /// host) have kept busy since construction, ≥ 0. System ticks are 10 ms, so about a second is
  /// needed for an accuracy of one percent. Empty if the system does not report it.
  [[nodiscard]] std::optional<double> of_others() const;

 private:
  /// Seconds of processor time and of wall time.
  struct Moment {
    double all_busy_s = 0;
    double own_busy_s = 0;
    double clock_s = 0;
  };

  static std::optional<Moment> now();

  std::optional<Moment> begin_;
};

}  // namespace vantage::scheduler
