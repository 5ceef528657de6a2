#include "engine/tuning/tuner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/error.h"
#include "engine/tuning/paired_race.h"

namespace vantage {
namespace {

// The final comparison: a measurement of the best plan between two of the default one.
constexpr int kFinalRounds = 9;
constexpr int kFewestFinalRounds = 5;  // if time is short; three are won by chance too often
// The time for this many of them is reserved, up to this share of the budget.
constexpr int kReservedRounds = 5;
constexpr double kMaxFinalShare = 0.3;
// Maximum number of sweeps over the coordinates; later improvements are below noise.
constexpr int kMaxSweeps = 5;
constexpr int kSearches = 2;

}  // namespace

/// Pairs that have raced, in either role, do not race again.
class Tuner::RacedPairs {
 public:
  void add(const TunedSettings& incumbent, const std::vector<TunedSettings>& candidates) {
    for (const TunedSettings& candidate : candidates) {
      pairs_.emplace_back(incumbent, candidate);
    }
  }
  [[nodiscard]] bool contains(const TunedSettings& a, const TunedSettings& b) const {
    return std::ranges::any_of(pairs_, [&](const auto& pair) {
      return (pair.first == a && pair.second == b) || (pair.first == b && pair.second == a);
    });
  }

 private:
  std::vector<std::pair<TunedSettings, TunedSettings>> pairs_;
};

Tuner::Tuner(TuningSubject& subject, TuningSubject& final_subject, const TuningClock& clock,
             const TunerOptions& options)
    : subject_(subject), final_subject_(final_subject), clock_(clock), options_(options) {
  if (!(options_.budget_seconds > 0 && options_.budget_seconds <= kMaxBudgetSeconds)) {
    throw UsageError(fmt::format("budget is {}, expected seconds above 0 and at most {}",
                                 options_.budget_seconds, kMaxBudgetSeconds));
  }
  options_.start.validate();
}

void Tuner::report(const BudgetedTrials& trials, std::string_view coordinate,
                   const TunedSettings& incumbent) const {
  if (on_progress_) {
    on_progress_({clock_() - begin_, trials.measurements(), coordinate, incumbent});
  }
}

bool Tuner::search(BudgetedTrials& trials, TunedSettings& incumbent) {
  // The second search confirms: noise may have hidden a gain from the first.
  for (int time = 0; time < kSearches; ++time) {
    RacedPairs raced;
    for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
      const TunedSettings before = incumbent;
      for (const TuningCoordinate& coordinate : kTuningCoordinates) {
        if (!search_coordinate(coordinate, sweep > 0, raced, trials, incumbent)) {
          return false;
        }
      }
      if (sweep > 0 && incumbent == before) {
        break;
      }
    }
  }
  return true;
}

bool Tuner::search_coordinate(const TuningCoordinate& coordinate, bool finely, RacedPairs& raced,
                              BudgetedTrials& trials, TunedSettings& incumbent) {
  trials.set_coordinate(coordinate.name);
  trials.on_measured([&] { report(trials, coordinate.name, incumbent); });
  std::vector<TunedSettings> candidates = subject_.candidates(coordinate, incumbent, finely);
  std::erase_if(candidates, [&](const TunedSettings& candidate) {
    return candidate == incumbent || raced.contains(candidate, incumbent);
  });
  if (candidates.empty()) {
    return true;
  }
  const RaceResult result = race(incumbent, candidates, trials);
  raced.add(incumbent, candidates);
  if (result.winner) {
    incumbent = *result.winner;
  }
  return result.complete;
}

TuningOutcome Tuner::tune() {
  begin_ = clock_();
  const double deadline = begin_ + options_.budget_seconds;
  const TunedSettings by_default;
  TuningOutcome outcome;

  BudgetedTrials trials(subject_, clock_, deadline, options_.stop);
  trials.on_measured([&] { report(trials, "default", options_.start); });
  TuningTrial& default_trial = trials.trial(by_default);
  default_trial.ratio_to_default = 1;
  TunedSettings incumbent = options_.start;
  // Twice: the first one allocates.
  const bool has_begun = trials.measure(by_default) && trials.measure(by_default);
  if (has_begun) {
    const double wanted =
        (3 * kReservedRounds + 2) * std::max(final_subject_.expected_seconds(by_default),
                                             final_subject_.expected_seconds(incumbent));
    trials.set_deadline(deadline - std::min(wanted, kMaxFinalShare * options_.budget_seconds));
    outcome.complete = search(trials, incumbent);
  }

  BudgetedTrials final_trials(final_subject_, clock_, deadline, options_.stop);
  if (has_begun && !(incumbent == by_default)) {
    final_trials.set_coordinate("final");
    final_trials.on_measured([&] { report(final_trials, "final", incumbent); });
    const PairedComparison comparison = compare(by_default, incumbent, kFinalRounds, final_trials);
    outcome.rounds = comparison.rounds();
    outcome.noise = comparison.noise();
    // Ties and unfinished comparisons go to the default.
    if (comparison.is_won(kFewestFinalRounds)) {
      outcome.settings = incumbent;
      outcome.ratio_to_default = comparison.median_ratio();
      outcome.frame_seconds = final_trials.trial(incumbent).median_seconds();
      outcome.default_frame_seconds = final_trials.trial(by_default).median_seconds();
    }
  }
  outcome.measurements = trials.measurements() + final_trials.measurements();
  outcome.interrupted = trials.is_stopped();
  outcome.trials = trials.trials();
  if (outcome.settings == by_default && !default_trial.frame_seconds.empty()) {
    outcome.frame_seconds = outcome.default_frame_seconds = default_trial.median_seconds();
  }
  outcome.elapsed_seconds = clock_() - begin_;
  return outcome;
}

}  // namespace vantage
