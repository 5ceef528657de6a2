#pragma once

#include <optional>

namespace vantage::scheduler {

/// Looks at how much of the machine other programs use while this one works.
///
/// Thread rule: of_others() may be called from any thread.
class ProcessorUse {
 public:
  ProcessorUse();

  /// How many processors other processes and the system (that of a virtual machine's host included)
  /// have kept busy since construction, in the mean; at least 0. Ticks of the system are 10 ms, so
  /// it takes about a second to be exact to a percent. Empty where the system does not tell.
  [[nodiscard]] std::optional<double> of_others() const;

 private:
  /// In seconds of processor time, and of the clock.
  struct Moment {
    double all_busy_s = 0;
    double own_busy_s = 0;
    double clock_s = 0;
  };

  static std::optional<Moment> now();

  std::optional<Moment> begin_;
};

}  // namespace vantage::scheduler
