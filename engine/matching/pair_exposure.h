#pragma once

#include <memory>

#include "engine/execution.h"
#include "engine/image/memory_use.h"
#include "engine/image/photograph.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/search/match_report.h"

namespace vantage {

class StereoMatcher;

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
