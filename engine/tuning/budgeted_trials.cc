#include "engine/tuning/budgeted_trials.h"

#include <algorithm>
#include <cmath>

namespace vantage {

double median(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t count = values.size();
  return (values[(count - 1) / 2] + values[count / 2]) / 2;
}

double spread(const std::vector<double>& values) {
  constexpr double kDeviationsPerSpread = 1.4826;  // of a normal distribution
  const double middle = median(values);
  std::vector<double> distances;
  for (const double value : values) {
    distances.push_back(std::abs(value - middle));
  }
  return kDeviationsPerSpread * median(std::move(distances));
}

double TuningTrial::median_seconds() const { return median(frame_seconds); }

bool BudgetedTrials::is_affordable(const TunedSettings& settings) const {
  return !is_stopped() && clock_() + subject_.expected_seconds(settings) <= deadline_;
}

std::optional<double> BudgetedTrials::measure(const TunedSettings& settings) {
  if (!is_affordable(settings)) {
    return std::nullopt;
  }
  const double seconds = subject_.measure(settings);
  trial(settings).frame_seconds.push_back(seconds);
  ++measurements_;
  if (on_measured_) {
    on_measured_();
  }
  return seconds;
}

TuningTrial& BudgetedTrials::trial(const TunedSettings& settings) {
  const auto known = std::ranges::find(trials_, settings, &TuningTrial::settings);
  if (known != trials_.end()) {
    return *known;
  }
  TuningTrial fresh;
  fresh.settings = settings;
  fresh.coordinate = coordinate_;
  return trials_.emplace_back(std::move(fresh));
}

}  // namespace vantage
