#pragma once

#include <memory>
#include <optional>

#include "engine/execution.h"
#include "engine/image/memory_use.h"
#include "engine/image/photograph.h"
#include "engine/matching/costs/level_change.h"
#include "engine/matching/options/match_options.h"

namespace vantage {

class StereoMatcher;

/// What a pair tells about its grey levels.
struct PairLevels {
  /// Turns the right image's levels into the left's; none where the pair does not tell.
  LevelChanges of_right;
  bool has_levels = false;
  /// σM in grey levels, at least 4: that of Birchfield and Tomasi's difference at matches, levels
  /// changed. Empty where there are few matches.
  std::optional<double> sigma_measurement;
  int matches = 0;  ///< that were looked at

  friend bool operator==(const PairLevels&, const PairLevels&) = default;
};

/// Finds out by how much the exposure of a pair's cameras differs, and how noisy they are: bands of
/// rows are matched by census codes, which no exposure changes, and the levels of pixels that both
/// maps agree on are compared. A part of the whole matching's time: at most an eighth of the rows
/// of large images, 96 of small ones.
///
/// Thread rule: estimate() may be called concurrently. Identical for any `execution`.
class PairLevelsEstimator {
 public:
  /// `range`: of the disparities of the pairs. `execution` must outlive the estimator.
  PairLevelsEstimator(DisparityRange range, Execution& execution);
  ~PairLevelsEstimator();

  /// Equal sizes. `colour`: what the costs compare: luma, or also the channels where both images
  /// have them. `change_levels`: else none are changed, and σ is that of levels as they are.
  /// Throws Error when no pixel has a candidate in the range.
  [[nodiscard]] PairLevels estimate(const Photograph& left, const Photograph& right,
                                    ColourUse colour, bool change_levels) const;

  /// As StereoMatcher::add_memory_use().
  void add_memory_use(MemoryUse& use) const;

 private:
  Execution& execution_;
  std::unique_ptr<StereoMatcher> matcher_;
};

}  // namespace vantage
