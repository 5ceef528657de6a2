#include "engine/matching/worth/map_shares.h"

#include <fmt/format.h>

#include <atomic>
#include <cstdint>
#include <limits>

#include "engine/image/left_out.h"

namespace vantage {
namespace {

/// Between the maps of scenes with ground truth and those of pairs that show nothing in common
/// (perf/log/2026-11-27-confidence.md).
constexpr double kDoubtfulShare = 0.45;

}  // namespace

MapShares map_shares(const FinishedMap& finished, Execution& execution) {
  const DisparityMap& disparity_px = finished.map->disparity_px;
  const Mask& left_out = finished.image->left_out;
  std::atomic<std::int64_t> matched = 0;
  std::atomic<std::int64_t> known = 0;
  execution.for_each_row(disparity_px.height(), [&](int y) {
    const float* const px = disparity_px.row(y);
    const std::uint8_t* const unmatched =
        finished.has_mask ? finished.map->unmatched.row(y) : nullptr;
    int matched_in_row = 0;
    int known_in_row = 0;
    for (int x = 0; x < disparity_px.width(); ++x) {
      const int is_known = px[x] <= std::numeric_limits<float>::max() ? 1 : 0;  // NaN: no
      known_in_row += is_known;
      matched_in_row += unmatched == nullptr || unmatched[x] == 0 ? is_known : 0;
    }
    known += known_in_row;
    matched += matched_in_row;
  });
  const double all = static_cast<double>(disparity_px.width()) * disparity_px.height();
  const double pixels = all * (left_out.empty() ? 1 : 1 - share_of(left_out));
  if (pixels < 1) {
    return {.unknown = 1};
  }
  return {.matched = static_cast<double>(matched) / pixels,
          .filled = static_cast<double>(known - matched) / pixels,
          .unknown = 1 - static_cast<double>(known) / pixels,
          .reliable = mean_confidence(finished, execution)};
}

void warn_of_doubtful_map(const MapShares& shares, std::vector<Remark>& remarks) {
  if (shares.reliable < kDoubtfulShare) {
    remarks.push_back(
        {Remark::Kind::kWarning, "map",
         fmt::format(
             "the map is hardly a measurement: about {:.0f} % of its disparities are within "
             "1 px, expected at least {:.0f} %; dark, blurred or empty images, or images "
             "of different scenes, look like this",
             100 * shares.reliable, 100 * kDoubtfulShare)});
  }
}

std::string to_text(const MapShares& shares) {
  std::string text = fmt::format("matched {:.0f} % of the pixels", 100 * shares.matched);
  if (shares.filled > 0) {
    text += fmt::format(", filled {:.0f} %", 100 * shares.filled);
  }
  if (shares.unknown > 0) {
    text += fmt::format(", unknown {:.0f} %", 100 * shares.unknown);
  }
  return text;
}

}  // namespace vantage
