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

/// Grey level statistics of a pair.
struct PairLevels {
  /// Maps the right image's levels to the left's; empty if the pair does not determine it.
  LevelChanges of_right;
  bool has_levels = false;
  /// σM in grey levels, at least 4: σ of Birchfield and Tomasi's difference at matches after the
  /// level change. Empty if there are too few matches.
  std::optional<double> sigma_measurement;
  int matches = 0;  ///< number of matches examined

  friend bool operator==(const PairLevels&, const PairLevels&) = default;
};

/// Estimates the exposure difference and the noise of a pair's cameras: matches bands of rows by
/// census codes, which are invariant to exposure, and compares the levels of pixels that both maps
/// agree on. Uses at most an eighth of the rows of large images, 96 rows of small ones, so it takes
/// a fraction of the matching time.
///
/// Thread rule: estimate() may be called concurrently. Identical for any `execution`.
class PairLevelsEstimator {
 public:
  /// `range`: disparity range of the pairs. `execution` must outlive the estimator.
  PairLevelsEstimator(DisparityRange range, Execution& execution);
  ~PairLevelsEstimator();

  /// Images of equal size. `colour`: compare luma, or also the channels where both images have
  /// them. `change_levels`: false: no level change, and σ refers to unchanged levels. Throws Error
  /// when no pixel has a candidate in the range.
  [[nodiscard]] PairLevels estimate(const Photograph& left, const Photograph& right,
                                    ColourUse colour, bool change_levels) const;

  /// As StereoMatcher::add_memory_use().
  void add_memory_use(MemoryUse& use) const;

 private:
  Execution& execution_;
  std::unique_ptr<StereoMatcher> matcher_;
};

}  // namespace vantage
