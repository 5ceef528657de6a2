#include "engine/matching/vertical_range.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "engine/error.h"
#include "engine/image/transposed.h"
#include "engine/matching/range_estimation.h"
#include "engine/rectification/feature_matches.h"
#include "engine/with_opencv.h"

namespace vantage {
namespace {

constexpr int kMaxFeatures = 1000;
constexpr int kLargestSide_px = 640;
constexpr int kMinVerticalMatches = 20;

// Shares of the matches. A few per cent are wrong, each by a different number of rows.
constexpr double kStrayMatches = 0.02;
constexpr double kApartMatches = 0.02;
// Pixels of the images in which features are detected.
constexpr double kMatchGap_px = 1;
constexpr double kMargin_px = 0.5;
/// Row offsets with at most this spread do not determine the camera positions.
constexpr double kOffsetsSpread_px = 4;

struct MatchSpan {
  double min_px = 0;
  double max_px = 0;
  [[nodiscard]] double length_px() const { return max_px - min_px; }
};

/// Span of the values without stray ones and small separate groups. Empty if all groups are small.
std::optional<MatchSpan> span_of_matches(std::vector<double> values, double gap_px) {
  std::sort(values.begin(), values.end());
  const auto count = static_cast<double>(values.size());
  const auto stray = static_cast<std::size_t>(std::ceil(kStrayMatches * count));
  const double min_group = std::max(3.0, kApartMatches * count);
  std::optional<MatchSpan> span;
  for (std::size_t start = stray; start + stray < values.size();) {
    std::size_t end = start + 1;
    while (end + stray < values.size() && values[end] - values[end - 1] <= gap_px) {
      ++end;
    }
    if (static_cast<double>(end - start) >= min_group) {
      span = MatchSpan{span ? span->min_px : values[start], values[end - 1]};
    }
    start = end;
  }
  return span;
}

DisparityRange whole_pixels(const MatchSpan& span, double margin_px) {
  return {static_cast<int>(std::floor(span.min_px - margin_px)),
          static_cast<int>(std::ceil(span.max_px + margin_px))};
}

}  // namespace

std::optional<DisparityRange> find_vertical_range(const Photograph& left, const Photograph& right,
                                                  Execution& execution) {
  if (!has_opencv()) {
    throw UsageError("disparities-y is auto, expected MIN:MAX: this build is without OpenCV");
  }
  if (left.width() != right.width() || left.height() != right.height()) {
    throw Error(fmt::format("left image is {}x{} but right image is {}x{}, expected equal sizes",
                            left.width(), left.height(), right.width(), right.height()));
  }
  const std::vector<PointMatch> matches = match_features(left, right,
                                                         {.kind = FeatureKind::kOrb,
                                                          .max_features = kMaxFeatures,
                                                          .largest_side_px = kLargestSide_px});
  if (static_cast<int>(matches.size()) < kMinVerticalMatches) {
    return std::nullopt;
  }
  std::vector<double> columns;
  std::vector<double> rows;
  for (const PointMatch& match : matches) {
    columns.push_back(match.left.x() - match.right.x());
    rows.push_back(match.left.y() - match.right.y());
  }
  const double scale =
      std::max(1.0, std::max(left.width(), left.height()) / static_cast<double>(kLargestSide_px));
  const std::optional<MatchSpan> across = span_of_matches(std::move(columns), kMatchGap_px * scale);
  const std::optional<MatchSpan> down = span_of_matches(std::move(rows), kMatchGap_px * scale);
  if (!across || !down) {
    return std::nullopt;
  }
  const double margin_px = kMargin_px * scale;
  const DisparityRange range = whole_pixels(*down, margin_px);
  if (down->length_px() <= std::max(across->length_px(), kOffsetsSpread_px * scale)) {
    return range;
  }
  // Row offsets depend on depth, and small surfaces have few points.
  const std::optional<DisparityRange> of_surfaces = find_disparity_range(
      transposed(left), transposed(right), execution, whole_pixels(*across, margin_px));
  return of_surfaces ? DisparityRange{std::min(range.min, of_surfaces->min),
                                      std::max(range.max, of_surfaces->max)}
                     : range;
}

DisparityRange require_vertical_range(const std::optional<DisparityRange>& found) {
  if (!found) {
    throw Error(
        "the images have too few points in common to estimate the vertical range, expected texture "
        "that both show; give `disparities-y` MIN:MAX");
  }
  return *found;
}

}  // namespace vantage
