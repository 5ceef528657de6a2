#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <string_view>
#include <vector>

#include "engine/tuning/budgeted_trials.h"

namespace vantage {

inline constexpr double kMaxBudgetSeconds = 1e6;

struct TunerOptions {
  /// From the call of tune() on; measurements that are not expected to end in time do not start.
  double budget_seconds = 60;
  /// Starting point of the search; the default plan unless a better one is known.
  TunedSettings start = {};
  const std::atomic<bool>* stop = nullptr;  ///< once set, no further measurement starts; not owned
};

/// Progress of a search.
struct TunerProgress {
  double elapsed_seconds = 0;
  int measurements = 0;
  std::string_view coordinate;  ///< being searched; "final" for the final comparison
  TunedSettings incumbent;      ///< the best so far
};

struct TuningOutcome {
  TunedSettings settings;  ///< to be used; all empty if nothing beats the default plan
  /// Per frame, medians of the final comparison; both are the default's if the search found nothing
  /// better. 0 if nothing could be measured.
  double frame_seconds = 0;
  double default_frame_seconds = 0;
  double ratio_to_default = 1;  ///< median of pairs
  int rounds = 0;               ///< of the final comparison
  /// Noise of the default plan in the final comparison, relative to its time.
  double noise = 0;
  int measurements = 0;
  double elapsed_seconds = 0;
  bool complete = false;           ///< the search converged within the budget
  bool interrupted = false;        ///< `stop` was raised
  std::deque<TuningTrial> trials;  ///< all settings tried in the search, the default first
};

/// Searches for settings that make `subject` fast: one coordinate after the other, with the
/// candidates of each raced against the best so far (race()), until nothing improves or time is up.
/// The result is then compared with the default plan once more, in pairs on `final_subject`, which
/// may be the same or a more faithful one; unless it wins beyond noise, the default is kept. So the
/// result is not slower than the default plan.
class Tuner {
 public:
  /// All must outlive the tuner. Throws UsageError for a budget that is not a positive number of
  /// seconds or a start out of range.
  Tuner(TuningSubject& subject, TuningSubject& final_subject, const TuningClock& clock,
        const TunerOptions& options);

  /// Called after each measurement.
  void on_progress(std::function<void(const TunerProgress&)> callback) {
    on_progress_ = std::move(callback);
  }

  TuningOutcome tune();

 private:
  class RacedPairs;

  /// True when nothing can improve any more; false when time is up.
  bool search(BudgetedTrials& trials, TunedSettings& incumbent);
  /// Searches one coordinate in one race; returns as search().
  bool search_coordinate(const TuningCoordinate& coordinate, bool finely, RacedPairs& raced,
                         BudgetedTrials& trials, TunedSettings& incumbent);
  void report(const BudgetedTrials& trials, std::string_view coordinate,
              const TunedSettings& incumbent) const;

  TuningSubject& subject_;
  TuningSubject& final_subject_;
  const TuningClock& clock_;
  TunerOptions options_;
  double begin_ = 0;
  std::function<void(const TunerProgress&)> on_progress_;
};

}  // namespace vantage
