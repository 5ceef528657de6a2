#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <string_view>
#include <vector>

#include "engine/tuning/budgeted_trials.h"

namespace vantage {

inline constexpr double kMostBudgetSeconds = 1e6;

struct TunerOptions {
  /// From the call of tune() on; measurements that are not expected to end in time do not begin.
  double budget_seconds = 60;
  /// Where the search begins; the default plan, unless something better is known.
  TunedSettings start = {};
  const std::atomic<bool>* stop = nullptr;  ///< once raised, nothing more is measured; not owned
};

/// Where a search stands.
struct TunerProgress {
  double elapsed_seconds = 0;
  int measurements = 0;
  std::string_view coordinate;  ///< being searched; "final" for the comparison at the end
  TunedSettings incumbent;      ///< the best so far
};

struct TuningOutcome {
  TunedSettings settings;  ///< to be used; all empty where nothing beats the default plan
  /// Of a frame, medians of the final comparison; both that of the default where nothing was better
  /// in the search. 0 where nothing could be measured.
  double frame_seconds = 0;
  double default_frame_seconds = 0;
  double ratio_to_default = 1;  ///< median of pairs
  int rounds = 0;               ///< of the final comparison
  /// By how much the default plan differed from itself in them, as a share of its time.
  double noise = 0;
  int measurements = 0;
  double elapsed_seconds = 0;
  bool complete = false;           ///< the search ended by itself, not by the budget
  bool interrupted = false;        ///< `stop` was raised
  std::deque<TuningTrial> trials;  ///< all that was tried in the search, the default first
};

/// Looks for settings that make `subject` fast: one coordinate after the other, the candidates of
/// each timed in turn with the best so far (race()), until nothing improves any more or time is
/// up. What was found is then compared once more with the default plan, in pairs on
/// `final_subject`, which may be the same or a more faithful one; unless it wins beyond noise, the
/// default stays. So the outcome is not slower than the default plan.
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

  /// True when nothing is left that could improve; false when time is up.
  bool search(BudgetedTrials& trials, TunedSettings& incumbent);
  /// The same of one coordinate, in one race.
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
