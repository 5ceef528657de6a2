#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/examination/image_statistics.h"
#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/matching/noise/noise_estimate.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/worth/map_shares.h"
#include "engine/rectification/rows/row_check.h"
#include "engine/remark.h"

namespace vantage {

/// What a pair is like, and what a match of it is worth.
struct PairExamination {
  std::array<ImageStatistics, 2> images;  ///< by index_of(Side)
  RowCheck rows;
  FoundNoise noise;
  std::optional<DisparityRange> disparities;  ///< that were searched; empty: there was no match
  MapShares shares;                           ///< of the left map
  double seconds = 0;                         ///< of the match, and of finding its range
  std::vector<Remark> remarks;                ///< of the match
  std::vector<std::string> problems;  ///< why a match makes no sense, a line each; empty: it does
};

/// Examines a pair that is ready for matching, corrects rows where that pays, and matches it with
/// `options`, large images reduced to 4 megapixels; `seconds` are then estimated. Images of equal
/// size. Results other than `seconds` are identical for any `execution`. Thread rule: may be called
/// concurrently.
PairExamination examine_pair(const Photograph& left, const Photograph& right,
                             const MatchOptions& options, Execution& execution);

}  // namespace vantage
