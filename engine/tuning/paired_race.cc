#include "engine/tuning/paired_race.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vantage {
namespace {

// A smaller gain does not justify a difference from the default.
constexpr double kMinGain = 0.01;
constexpr double kStandardErrors = 2;
// A winner may lose none of the first kRoundsToWin rounds, and one of each kRoundsPerLoss more: by
// chance that happens once in twenty times.
constexpr int kRoundsToWin = 3;
constexpr int kRoundsPerLoss = 4;
constexpr int kMinRounds = 5;
constexpr int kMaxRounds = 15;
// Fewer rounds decide nothing, even if time ran out.
constexpr int kFewestRounds = 3;
// The first measurement of a plan only shows whether it is hopeless.
constexpr double kHopelessTimeRatio = 1.4;
// In a round's ranking, this share behind the best and beyond twice the noise is clearly slower.
constexpr double kClearlyBehind = 0.03;
// Assumed noise until there are enough rounds to estimate it.
constexpr double kNoiseAtFirst = 0.08;

struct Runner {
  TunedSettings settings;
  double first_seconds = 0;
  PairedComparison comparison;
};

/// Measures every candidate once; empty if there was no time for any.
std::vector<Runner> scout(const TunedSettings& incumbent,
                          const std::vector<TunedSettings>& candidates, BudgetedTrials& trials) {
  std::vector<Runner> runners;
  const std::optional<double> incumbent_seconds = trials.measure(incumbent);
  if (!incumbent_seconds) {
    return runners;
  }
  double min = *incumbent_seconds;
  for (const TunedSettings& candidate : candidates) {
    // Slow candidates may precede fast ones, so the search continues after one without enough time.
    if (const std::optional<double> seconds = trials.measure(candidate)) {
      min = std::min(min, *seconds);
      runners.push_back({candidate, *seconds, {}});
    }
  }
  for (const Runner& runner : runners) {
    if (runner.first_seconds > kHopelessTimeRatio * min) {
      trials.trial(runner.settings).ratio_to_default =
          trials.trial(incumbent).ratio_to_default.value_or(1) * runner.first_seconds /
          *incumbent_seconds;
    }
  }
  std::erase_if(runners, [&](const Runner& runner) {
    return runner.first_seconds > kHopelessTimeRatio * min;
  });
  return runners;
}

/// One round; false when time ran out in it. Its measurements so far count for the runners
/// measured.
bool run_round(const TunedSettings& incumbent, std::vector<Runner>& runners, bool incumbent_first,
               BudgetedTrials& trials) {
  std::vector<std::optional<double>> seconds(runners.size());
  std::optional<double> incumbent_seconds;
  const auto measure_incumbent = [&] {
    incumbent_seconds = trials.measure(incumbent);
    return incumbent_seconds.has_value();
  };
  if (incumbent_first && !measure_incumbent()) {
    return false;
  }
  bool complete = true;
  for (std::size_t i = 0; i < runners.size() && complete; ++i) {
    const std::size_t index = incumbent_first ? i : runners.size() - 1 - i;
    seconds[index] = trials.measure(runners[index].settings);
    complete = seconds[index].has_value();
  }
  if (!complete || (!incumbent_first && !measure_incumbent())) {
    return false;
  }
  for (std::size_t i = 0; i < runners.size(); ++i) {
    runners[i].comparison.ratios.push_back(*seconds[i] / *incumbent_seconds);
  }
  return true;
}

void note_ratios(const TunedSettings& incumbent, const std::vector<Runner>& runners,
                 BudgetedTrials& trials) {
  const double of_incumbent = trials.trial(incumbent).ratio_to_default.value_or(1);
  for (const Runner& runner : runners) {
    trials.trial(runner.settings).ratio_to_default =
        of_incumbent * runner.comparison.median_ratio();
  }
}

/// Drops the clearly slower runners and, from the second round on, the slower half; best first.
void drop_slow(std::vector<Runner>& runners, int round) {
  std::ranges::stable_sort(runners, {},
                           [](const Runner& runner) { return runner.comparison.median_ratio(); });
  const std::vector<double>& of_best = runners.front().comparison.ratios;
  const double noise = round < kFewestRounds ? kNoiseAtFirst : spread(of_best) / std::sqrt(round);
  const double limit = runners.front().comparison.median_ratio() *
                       (1 + std::max(kClearlyBehind, kStandardErrors * noise));
  if (round > 1) {
    runners.resize((runners.size() + 1) / 2);
  }
  std::erase_if(runners,
                [&](const Runner& runner) { return runner.comparison.median_ratio() > limit; });
}

/// Whether the challenger is unlikely to win with more rounds.
bool is_lost(const PairedComparison& comparison) {
  return comparison.rounds() >= kFewestRounds && 2 * comparison.wins() <= comparison.rounds();
}

}  // namespace

int PairedComparison::wins() const {
  return static_cast<int>(std::ranges::count_if(ratios, [](double ratio) { return ratio < 1; }));
}

double PairedComparison::noise() const {
  constexpr double kDeviationsPerMedian = 1.4826;  // of a normal distribution around 1
  std::vector<double> distances;
  for (const double ratio : repeats) {
    distances.push_back(std::abs(ratio - 1));
  }
  return distances.empty() ? 0 : kDeviationsPerMedian * median(std::move(distances));
}

bool PairedComparison::is_won(int min_rounds) const {
  if (rounds() < std::max(1, min_rounds)) {
    return false;
  }
  const double error = spread(ratios) / std::sqrt(rounds());
  const int losses = rounds() - wins();
  return losses <= (rounds() - kRoundsToWin) / kRoundsPerLoss &&
         1 - median_ratio() >= std::max({kMinGain, kStandardErrors * error, noise()});
}

RaceResult race(const TunedSettings& incumbent, const std::vector<TunedSettings>& candidates,
                BudgetedTrials& trials) {
  RaceResult result;
  std::vector<Runner> runners = scout(incumbent, candidates, trials);
  bool in_time = !runners.empty() || trials.is_affordable(incumbent);
  for (int round = 1; in_time && !runners.empty() && round <= kMaxRounds; ++round) {
    in_time = run_round(incumbent, runners, round % 2 == 1, trials);
    if (!in_time) {
      break;
    }
    note_ratios(incumbent, runners, trials);
    drop_slow(runners, round);
    if (is_lost(runners.front().comparison)) {
      return result;
    }
    if (runners.size() == 1 && runners.front().comparison.is_won(kMinRounds)) {
      break;
    }
  }
  result.complete = in_time;
  if (!runners.empty()) {
    Runner& best = runners.front();
    if (best.comparison.is_won(in_time ? kMinRounds : kFewestRounds)) {
      result.winner = best.settings;
      result.comparison = std::move(best.comparison);
    }
  }
  return result;
}

PairedComparison compare(const TunedSettings& incumbent, const TunedSettings& challenger,
                         int rounds, BudgetedTrials& trials) {
  std::vector<Runner> runners(1);
  runners.front().settings = challenger;
  PairedComparison& comparison = runners.front().comparison;
  // The first measurements also allocate, so they do not count.
  if (!trials.measure(incumbent) || !trials.measure(challenger)) {
    return comparison;
  }
  // Stopping as soon as it looks good would accept chance results more often.
  for (int round = 1; round <= rounds && !is_lost(comparison); ++round) {
    const auto before = trials.measure(incumbent);
    const auto seconds = before ? trials.measure(challenger) : std::nullopt;
    const auto after = seconds ? trials.measure(incumbent) : std::nullopt;
    if (!after) {
      break;
    }
    comparison.ratios.push_back(2 * *seconds / (*before + *after));
    comparison.repeats.push_back(*after / *before);
  }
  if (!comparison.ratios.empty()) {
    note_ratios(incumbent, runners, trials);
  }
  return comparison;
}

}  // namespace vantage
