#pragma once

#include <string>
#include <vector>

#include "engine/execution.h"
#include "engine/matching/worth/map_confidence.h"
#include "engine/remark.h"

namespace vantage {

/// What the pixels of a map are: the first three sum to 1. Pixels that are left out do not count.
struct MapShares {
  double matched = 0;
  double filled = 0;   ///< from their neighbours
  double unknown = 0;  ///< without a disparity
  /// Expected share of the disparities that are within 1 px of the true ones: the mean confidence
  /// of a sample.
  double reliable = 0;
};

/// Identical for any `execution`.
MapShares map_shares(const FinishedMap& finished, Execution& execution);

/// "matched 83 % of the pixels, filled 17 %"; filled and unknown pixels only where there are some.
std::string to_text(const MapShares& shares);

/// Adds a warning where a map is hardly a measurement.
void warn_of_doubtful_map(const MapShares& shares, std::vector<Remark>& remarks);

}  // namespace vantage
