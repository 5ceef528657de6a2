#pragma once

#include <optional>

#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/matching/options/match_options.h"

namespace vantage {

/// Where a rectified pair shows what is infinitely far.
enum class Infinity {
  kAtZero,   ///< at disparity 0, so that few negative matches are errors
  kAnywhere  ///< films are shifted, so that things are in front of and behind the screen
};

/// Disparity range to search in a rectified pair: that of the windows of both reduced images that
/// are evidence (find_window_matches()), from −width/8 to width/3, without groups that may be
/// chance, plus a margin, which is wider where little of the images is matched. Sky, walls, noise
/// and repeated texture do not count; where they fill parts of the image, things far behind them
/// are likely, and the range begins by that share nearer to 0. It starts at 0 or above unless at
/// least 2 % of the matches are negative or `infinity` is anywhere. Empty if there is hardly any
/// evidence: constant images, noise, unrelated images.
///
/// Images of 512 to 1280 pixels width are reduced to a quarter, larger ones to a width of 320, so
/// that the time is a few per cent of the matching time; surfaces of less than a window, 3 × 7
/// reduced pixels, can be missed.
///
/// `vertical`: range of y_left − y_right of an unrectified pair.
///
/// Throws Error when sizes differ. Identical for any `execution` and on every instruction set.
/// Thread rule: may be called concurrently.
std::optional<DisparityRange> find_disparity_range(const Photograph& left, const Photograph& right,
                                                   Execution& execution,
                                                   DisparityRange vertical = {0, 0},
                                                   Infinity infinity = Infinity::kAtZero);

/// The range found; throws Error where there is none.
DisparityRange require_disparity_range(const std::optional<DisparityRange>& found);

/// As find_disparity_range(); throws Error instead of returning an empty result.
DisparityRange estimate_disparity_range(const Photograph& left, const Photograph& right,
                                        Execution& execution);

/// Shares outside a range, of the matches that find_disparity_range() counts.
struct DisparitiesBeyond {
  double below = 0;  ///< share below the range by more than the accuracy of that search
  double above = 0;
  bool reaches_below = true;  ///< whether the search can find any
  bool reaches_above = true;
};

/// Shares are 0 if there is hardly any evidence. Errors, `vertical` and thread rule as
/// find_disparity_range().
DisparitiesBeyond disparities_beyond(const Photograph& left, const Photograph& right,
                                     DisparityRange range, Execution& execution,
                                     DisparityRange vertical = {0, 0});

}  // namespace vantage
