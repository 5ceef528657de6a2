#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/tuning/tuning_subject.h"

namespace vantage {

/// Measurements of one setting.
struct TuningTrial {
  TunedSettings settings;
  std::string_view coordinate;        ///< searched at the time; "default", "final"
  std::vector<double> frame_seconds;  ///< of all measurements, in order
  /// Time of a frame ÷ that of the default plan, from pairs of consecutive measurements, along the
  /// chain of incumbents; empty until there is such a pair.
  std::optional<double> ratio_to_default = std::nullopt;

  /// Median of frame_seconds, which must not be empty.
  [[nodiscard]] double median_seconds() const;
};

/// Median of `values` (not empty); the mean of the two middle ones for even sizes.
double median(std::vector<double> values);

/// Half the interquartile range of `values`, scaled to a standard deviation.
double spread(const std::vector<double>& values);

/// Measures a subject until time is up, and records the results.
class BudgetedTrials {
 public:
  /// `subject` and `clock` must outlive this object. No measurement starts that is expected to end
  /// after `deadline` (of `clock`), or once `stop` is set.
  BudgetedTrials(TuningSubject& subject, const TuningClock& clock, double deadline,
                 const std::atomic<bool>* stop)
      : subject_(subject), clock_(clock), deadline_(deadline), stop_(stop) {}

  /// Called after each measurement.
  void on_measured(std::function<void()> callback) { on_measured_ = std::move(callback); }
  void set_deadline(double deadline) { deadline_ = deadline; }
  /// Name under which the next measurements are recorded.
  void set_coordinate(std::string_view name) { coordinate_ = name; }

  [[nodiscard]] bool is_affordable(const TunedSettings& settings) const;
  [[nodiscard]] bool is_stopped() const { return stop_ != nullptr && stop_->load(); }
  /// Seconds per frame; empty if not enough time is left.
  std::optional<double> measure(const TunedSettings& settings);

  /// The record of `settings`, created if missing; the reference stays valid.
  TuningTrial& trial(const TunedSettings& settings);
  [[nodiscard]] const std::deque<TuningTrial>& trials() const { return trials_; }
  [[nodiscard]] int measurements() const { return measurements_; }

 private:
  TuningSubject& subject_;
  const TuningClock& clock_;
  double deadline_;
  const std::atomic<bool>* stop_;
  std::function<void()> on_measured_;
  std::string_view coordinate_ = "default";
  std::deque<TuningTrial> trials_;  // deque: trial() returns references
  int measurements_ = 0;
};

}  // namespace vantage
