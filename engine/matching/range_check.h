#pragma once

#include <string>

#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/image/disparity_range.h"
#include "engine/image/photograph.h"
#include "engine/matching/options/match_options.h"

namespace vantage {

/// Shares of the matched pixels of a map that are within a pixel of the ends of the range which was
/// searched. Where a range is too narrow, surfaces beyond an end, and what is near them, win at it.
struct MatchesAtEnds {
  double at_min = 0;
  double at_max = 0;
  double unmatched = 0;  ///< of all pixels, those without a match
};

/// Of the map of the reference, as StereoMatcher::match() makes it, with its mask (without one all
/// known pixels are matched). Thread rule: pure.
MatchesAtEnds matches_at_ends(const DisparityMaps& maps, const MatchOptions& options);

/// What seems to be missing from a range.
struct CutRange {
  bool below = false;  ///< at its minimum
  bool above = false;
  MatchesAtEnds at_ends;
  /// Of what both images show in a search of reduced images the shares beyond the ends.
  double share_below = 0;
  double share_above = 0;

  [[nodiscard]] bool any() const { return below || above; }
};

/// Whether the range may be too narrow: more than a hundredth of the matches are at an end, or more
/// than a fifth of the pixels have none. A range that was found (`is_found`) may end at 0, where
/// infinity is, and has been looked at already.
bool may_be_cut(const MatchesAtEnds& matches, const MatchOptions& options, bool is_found);

/// Looks whether a range that may_be_cut() is too narrow. A scene may end where it does, so the
/// pair is searched once more, as find_disparity_range() does, and more than a fiftieth of what
/// that sees must lie beyond, and more than a tenth of what is at the end. Where it cannot see so
/// far, the matches at the end decide. Thread rule: may be called concurrently.
CutRange look_beyond(const MatchesAtEnds& matches, const Photograph& left, const Photograph& right,
                     const MatchOptions& options, Execution& execution);

/// "disparities above 49 seem to be left out: 11.1 % of the matches lie at that end of the search".
std::string to_text(const CutRange& cut, DisparityRange range);

}  // namespace vantage
