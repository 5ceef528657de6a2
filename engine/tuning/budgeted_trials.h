#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/tuning/tuning_subject.h"

namespace vantage {

/// All that is known of one way to do the work.
struct TuningTrial {
  TunedSettings settings;
  std::string_view coordinate;        ///< that was being searched; "default", "final"
  std::vector<double> frame_seconds;  ///< of all measurements, in order
  /// Time of a frame ÷ that of the default plan, from pairs of measurements next to each other,
  /// along the chain of incumbents; empty as long as there is no such pair.
  std::optional<double> ratio_to_default = std::nullopt;

  /// Of frame_seconds, which must not be empty.
  [[nodiscard]] double median_seconds() const;
};

/// The middle of `values`, which must not be empty; the mean of the two middle ones.
double median(std::vector<double> values);

/// Half the width of what holds the middle half of `values`, scaled to a standard deviation.
double spread(const std::vector<double>& values);

/// Measures a subject for as long as there is time, and keeps a record of it.
class BudgetedTrials {
 public:
  /// `subject` and `clock` must outlive this object. No measurement begins that is expected to end
  /// after `deadline` (of `clock`), none at all once `stop` is raised.
  BudgetedTrials(TuningSubject& subject, const TuningClock& clock, double deadline,
                 const std::atomic<bool>* stop)
      : subject_(subject), clock_(clock), deadline_(deadline), stop_(stop) {}

  /// Called after each measurement.
  void on_measured(std::function<void()> callback) { on_measured_ = std::move(callback); }
  void set_deadline(double deadline) { deadline_ = deadline; }
  /// What the next measurements are recorded as.
  void set_coordinate(std::string_view name) { coordinate_ = name; }

  [[nodiscard]] bool is_affordable(const TunedSettings& settings) const;
  [[nodiscard]] bool is_stopped() const { return stop_ != nullptr && stop_->load(); }
  /// Seconds of a frame; empty when there is not enough time left.
  std::optional<double> measure(const TunedSettings& settings);

  /// The record of `settings`, made if there is none; stays where it is.
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
  std::deque<TuningTrial> trials_;  // deque: trial() hands out references
  int measurements_ = 0;
};

}  // namespace vantage
