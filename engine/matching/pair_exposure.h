#pragma once

#include <memory>
#include <optional>

#include "engine/execution.h"
#include "engine/image/memory_use.h"
#include "engine/image/photograph.h"
#include "engine/matching/costs/intensity_change.h"
#include "engine/matching/options/match_options.h"

namespace vantage {

class StereoMatcher;

/// Intensity statistics of a pair.
struct PairExposure {
  /// Maps the right image's intensities to the left's; empty if the pair does not determine it.
  IntensityChanges of_right;
  bool has_intensity_change = false;
  /// σM in grey levels, at least 4: σ of Birchfield and Tomasi's difference at matches after the
  /// intensity change. Empty if there are too few matches.
  std::optional<double> sigma_measurement;
  int matches = 0;  ///< number of matches examined

  friend bool operator==(const PairExposure&, const PairExposure&) = default;
};

/// Estimates the exposure difference and the noise of a pair's cameras: matches bands of rows by
/// census codes, which are invariant to exposure, and compares the intensities of pixels that both
/// maps agree on. Uses at most an eighth of the rows of large images, 96 rows of small ones, so it
/// takes a fraction of the matching time.
///
/// Thread rule: estimate() may be called concurrently. Identical for any `execution`.
class PairExposureEstimator {
 public:
  /// `range`: disparity range of the pairs. `execution` must outlive the estimator.
  PairExposureEstimator(DisparityRange range, Execution& execution);
  ~PairExposureEstimator();

  /// Images of equal size. `colour`: compare luma, or also the channels where both images have
  /// them. `changes_intensities`: false: no change, and σ refers to unchanged intensities. Throws
  /// Error when no pixel has a candidate in the range.
  [[nodiscard]] PairExposure estimate(const Photograph& left, const Photograph& right,
                                      ColourUse colour, bool changes_intensities) const;

  /// As StereoMatcher::add_memory_use().
  void add_memory_use(MemoryUse& use) const;

 private:
  Execution& execution_;
  std::unique_ptr<StereoMatcher> matcher_;
};

}  // namespace vantage
