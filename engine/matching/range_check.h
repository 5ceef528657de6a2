#pragma once

#include <string>
#include <string_view>

#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/image/disparity_range.h"
#include "engine/image/photograph.h"
#include "engine/matching/options/match_options.h"
#include "engine/remark.h"

namespace vantage {

/// Shares of a map's matched pixels within a pixel of the ends of the search range. If a range is
/// too narrow, surfaces beyond an end and their surroundings win at that end.
struct MatchesAtEnds {
  double at_min = 0;
  double at_max = 0;
  double unmatched = 0;  ///< share of all pixels without a match
};

/// Examines the map of the reference as returned by StereoMatcher::match(), with its mask (without
/// one, all known pixels count as matched). Thread rule: pure.
MatchesAtEnds matches_at_ends(const DisparityMaps& maps, const MatchOptions& options);

/// Ends at which a range seems to be cut off.
struct CutRange {
  bool below = false;  ///< at its minimum
  bool above = false;
  MatchesAtEnds at_ends;
  /// Shares beyond the ends, of the disparities both images agree on in a search of reduced images.
  double share_below = 0;
  double share_above = 0;

  [[nodiscard]] bool any() const { return below || above; }
};

/// Whether the range may be too narrow: more than 1 % of the matches are at an end, or more than
/// 20 % of the pixels have none. An estimated range (`is_found`) may end at 0, which is infinity,
/// and has been checked already.
bool may_be_cut(const MatchesAtEnds& matches, const MatchOptions& options, bool is_found);

/// Checks whether a range that may_be_cut() is too narrow. The scene may end at that disparity, so
/// the pair is searched again as by find_disparity_range(): more than 2 % of the disparities found
/// must lie beyond, and more than a tenth of the share at the end. If that search does not reach
/// beyond, the matches at the end decide. Thread rule: may be called concurrently.
CutRange look_beyond(const MatchesAtEnds& matches, const Photograph& left, const Photograph& right,
                     const MatchOptions& options, Execution& execution);

/// Advice at the end of a warning of a range that was given.
inline constexpr std::string_view kCutRangeAdvice =
    "give a wider `disparities`, or leave it out for auto";

/// The warning: to_text() and advice. `is_found`: the range was estimated.
Remark cut_range_remark(const CutRange& cut, DisparityRange range, bool is_found);

/// "disparities above 49 seem to be left out: 11 % of the matches lie at that end".
std::string to_text(const CutRange& cut, DisparityRange range);

}  // namespace vantage
