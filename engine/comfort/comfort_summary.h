#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/comfort/comfort_limits.h"
#include "engine/comfort/frame_comfort.h"

namespace vantage {

/// Frames [first, end) that belong together.
struct ComfortSpan {
  int first_frame = 0;
  int end_frame = 0;
};

/// One judged property of a shot or film.
struct ComfortFinding {
  std::string name;  ///< "crossed"
  ComfortVerdict verdict = ComfortVerdict::kSafe;
  std::string text;  ///< "2.9 % of the width in front of the screen"
};

/// Frames that belong together, as one. Percentages of disparities are of the width.
struct ComfortSummary {
  ComfortSpan span;
  int frames = 0;  ///< measured
  int width_px = 0;
  int height_px = 0;
  /// Disparities that 1, 5, 50, 95 and 99 % of the matched pixels of all frames have at most.
  std::array<double, 5> percentiles_px = {};
  double crossed_percent = 0;    ///< nearest (99 %) in front of the screen, 0 if nothing is
  double uncrossed_percent = 0;  ///< farthest (1 %) behind the screen, 0 if nothing is
  double budget_percent = 0;     ///< from the 1st to the 99th percentile
  double matched_percent = 0;    ///< of the pixels
  struct Border {
    int frames = 0;           ///< in which more rows than ComfortLimits::border are cut
    double rows_percent = 0;  ///< in the worst frame
    double disparity_px = 0;  ///< of the nearest there
    int worst_frame = 0;
  };
  std::array<Border, 2> borders = {};      ///< left, right
  std::optional<double> vertical_px;       ///< median over frames of the smooth part of the error
  std::optional<double> vertical_mean_px;  ///< median over frames of y_left − y_right
  int order_right = 0;
  int order_wrong = 0;
  bool exchanged = false;
  std::array<double, 3> colour = {};  ///< mean of left − right, levels of 255
  /// Median disparity of the first frame less that of the last frame before it; empty for the first
  /// shot, and for films.
  std::optional<double> jump_px;
  /// To be added to all disparities: the left image moves to the right by this, or the right one to
  /// the left. The smallest shift that puts the 1st to 99th percentile within the safe limits, or
  /// exceeds them as little as possible.
  double shift_px = 0;
  std::vector<ComfortFinding> findings;
  ComfortVerdict verdict = ComfortVerdict::kSafe;  ///< the worst one
};

struct ComfortReport {
  ComfortSummary film;
  std::vector<ComfortSummary> shots;
};

/// Judges frames by number; frames outside the spans (contiguous, ascending) do not count. Spans
/// without frames are left out. Thread rule: pure.
ComfortReport summarise_comfort(const std::map<int, FrameComfort>& frames,
                                const std::vector<ComfortSpan>& shots);

}  // namespace vantage
