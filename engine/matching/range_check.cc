#include "engine/matching/range_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "engine/matching/range_estimation.h"

namespace vantage {
namespace {

// Measured on 18 scenes with ground truth and the preset balanced: estimated ranges have less than
// 0.1 % of the matches at an end other than 0; ranges without the top tenth of the ground truth
// have at least 4 %.
constexpr double kPileShare = 0.01;
/// One of those scenes has 32 %, one 26 % and the others have less, for any range.
constexpr double kUnmatchedShare = 0.2;
constexpr double kBeyondShare = 0.02;
/// If a surface lies at an end, this share of it may seem to lie beyond.
constexpr double kScatterShare = 0.1;

bool piles_up_at_min(const MatchesAtEnds& matches, const MatchOptions& options, bool is_found) {
  return matches.at_min > kPileShare && !(is_found && options.disparities.min == 0);
}

bool piles_up_at_max(const MatchesAtEnds& matches) { return matches.at_max > kPileShare; }

std::string end_text(std::string_view side, int end, double at_end, double beyond) {
  std::string text =
      fmt::format("disparities {} {} seem to be left out: {:.3g} % of the matches lie at that end",
                  side, end, 100 * at_end);
  if (beyond > 0) {
    text += fmt::format(", {:.3g} % of what both images show beyond", 100 * beyond);
  }
  return text;
}

}  // namespace

MatchesAtEnds matches_at_ends(const DisparityMaps& maps, const MatchOptions& options) {
  const DisparityMap& map = maps.of(options.reference).disparity_px;
  const Mask& unmatched = maps.of(options.reference).unmatched;
  const auto low = static_cast<float>(options.disparities.min + 1);
  const auto high = static_cast<float>(options.disparities.max - 1);
  long long matched = 0;
  long long at_min = 0;
  long long at_max = 0;
  const std::vector<std::uint8_t> all_matched(static_cast<std::size_t>(map.width()));
  for (int y = 0; y < map.height(); ++y) {
    const float* const px = map.row(y);
    const std::uint8_t* const mask = unmatched.empty() ? all_matched.data() : unmatched.row(y);
    // Without branches and in 32 bits, which compilers find vectors for.
    constexpr float kMax = std::numeric_limits<float>::max();
    std::int32_t matched_in_row = 0;
    std::int32_t low_in_row = 0;
    std::int32_t high_in_row = 0;
    for (int x = 0; x < map.width(); ++x) {
      const std::int32_t is_matched = (std::abs(px[x]) <= kMax ? 1 : 0) & (mask[x] == 0 ? 1 : 0);
      matched_in_row += is_matched;
      low_in_row += is_matched & (px[x] < low ? 1 : 0);
      high_in_row += is_matched & (px[x] > high ? 1 : 0);
    }
    matched += matched_in_row;
    at_min += low_in_row;
    at_max += high_in_row;
  }
  if (matched == 0) {
    return {.unmatched = 1};
  }
  const auto count = static_cast<double>(matched);
  return {.at_min = static_cast<double>(at_min) / count,
          .at_max = static_cast<double>(at_max) / count,
          .unmatched = 1 - count / (static_cast<double>(map.width()) * map.height())};
}

bool may_be_cut(const MatchesAtEnds& matches, const MatchOptions& options, bool is_found) {
  return piles_up_at_min(matches, options, is_found) || piles_up_at_max(matches) ||
         (matches.unmatched > kUnmatchedShare && !is_found);
}

CutRange look_beyond(const MatchesAtEnds& matches, const Photograph& left, const Photograph& right,
                     const MatchOptions& options, Execution& execution) {
  const DisparitiesBeyond beyond =
      disparities_beyond(left, right, options.disparities, execution,
                         options.disparities_y.value_or(DisparityRange{0, 0}));
  const auto is_cut = [&](bool piles_up, double at_end, double share, bool reaches) {
    if (piles_up && !reaches) {
      return true;
    }
    return (piles_up || matches.unmatched > kUnmatchedShare) &&
           share > std::max(kBeyondShare, kScatterShare * at_end);
  };
  return {
      .below = is_cut(piles_up_at_min(matches, options, false), matches.at_min, beyond.below,
                      beyond.reaches_below),
      .above = is_cut(piles_up_at_max(matches), matches.at_max, beyond.above, beyond.reaches_above),
      .at_ends = matches,
      .share_below = beyond.below,
      .share_above = beyond.above};
}

Remark cut_range_remark(const CutRange& cut, DisparityRange range, bool is_found) {
  return {Remark::Kind::kWarning, "range",
          fmt::format("{}; {}", to_text(cut, range),
                      is_found ? "give `disparities` MIN:MAX" : kCutRangeAdvice)};
}

std::string to_text(const CutRange& cut, DisparityRange range) {
  std::string text;
  if (cut.below) {
    text = end_text("below", range.min, cut.at_ends.at_min, cut.share_below);
  }
  if (cut.above) {
    text +=
        (cut.below ? "; " : "") + end_text("above", range.max, cut.at_ends.at_max, cut.share_above);
  }
  return text;
}

}  // namespace vantage
