#pragma once

#include <optional>
#include <vector>

#include "engine/tuning/budgeted_trials.h"

namespace vantage {

/// Result of comparing two plans, measured alternately.
struct PairedComparison {
  std::vector<double> ratios;  ///< challenger ÷ incumbent, one per round
  /// If the incumbent is measured twice in a round, before and after the challenger: the second
  /// time ÷ the first. Deviations from 1 are noise.
  std::vector<double> repeats = {};

  [[nodiscard]] int rounds() const { return static_cast<int>(ratios.size()); }
  [[nodiscard]] int wins() const;  ///< rounds in which the challenger was faster
  [[nodiscard]] double median_ratio() const { return median(ratios); }
  /// Standard deviation of the incumbent's repeats; 0 without repeats.
  [[nodiscard]] double noise() const;
  /// Whether the challenger is faster beyond noise: by at least 1 %, twice the standard error and
  /// noise(), in all but a few of at least `min_rounds` rounds.
  [[nodiscard]] bool is_won(int min_rounds) const;
};

struct RaceResult {
  std::optional<TunedSettings> winner;  ///< empty: the incumbent stays
  PairedComparison comparison;          ///< of the winner
  bool complete = true;                 ///< false: time ran out before it was decided
};

/// Times `candidates` and `incumbent` alternately, round by round, so that changes in the machine's
/// speed affect all of them. After each round those clearly slower are dropped, and of the others
/// the slower half. The last one must beat the incumbent beyond noise.
RaceResult race(const TunedSettings& incumbent, const std::vector<TunedSettings>& candidates,
                BudgetedTrials& trials);

/// Compares two plans in `rounds` rounds, each with the incumbent before and after the challenger;
/// ends early when the challenger cannot win any more.
PairedComparison compare(const TunedSettings& incumbent, const TunedSettings& challenger,
                         int rounds, BudgetedTrials& trials);

}  // namespace vantage
