#include "engine/matching/range_estimation.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <optional>
#include <vector>

#include "engine/error.h"
#include "engine/image/intensity_rows.h"
#include "engine/matching/estimation/window_matches.h"
#include "engine/matching/options/match_options.h"

namespace vantage {
namespace {

/// Images are reduced by at most this factor as long as they stay at least kMinWidthPx wide, and
/// by more if they would stay wider than kMaxWidthPx. A search takes 1/factor³ of its time on full
/// images, so these determine the cost of the estimate.
constexpr int kUsualFactor = 4;
constexpr int kMinWidthPx = 128;
constexpr int kMaxWidthPx = 320;

/// Support of a region (MatchedRegion) from which on it counts: regions by chance have less.
constexpr double kMinSupport = 3;
/// Share of the pixels that the support of all regions must reach; unrelated images agree on a few
/// windows by chance.
constexpr double kMinSupportShare = 0.001;
/// Regions separated from all others by more than this many reduced pixels, plus this fraction of
/// their disparity, are groups of their own, and count from this share of the whole support on:
/// chance and repeated texture make small ones.
constexpr double kGapPx = 2;
constexpr double kGapRatio = 0.1;
constexpr double kApartShare = 0.003;
/// The same behind everything else, but not behind infinity: background that little is seen of.
constexpr double kBehindShare = 0.001;
/// Share of negative matches below which infinity is the end: a small part of an untextured sky
/// may match at any disparity.
constexpr double kNegativeShare = 0.02;
/// Matches spread over a larger part of the search range are random.
constexpr double kMaxSpread = 0.75;

/// The range is widened by this plus this fraction of it: matches are accurate to reduced pixels.
constexpr double kMarginReducedPx = 0.5;
constexpr double kMarginPx = 1;
constexpr double kMarginRatio = 0.03;
/// And by so much where nothing matches; by nothing more where the support reaches kFullSupport of
/// the pixels.
constexpr double kUnseenReducedPx = 0.5;
constexpr double kUnseenRatio = 0.1;
constexpr double kFullSupport = 0.4;

int reduction_of(int width) {
  const auto parts = [width](int part) { return (width + part - 1) / part; };
  return std::max({1, std::min(kUsualFactor, parts(kMinWidthPx)), parts(kMaxWidthPx)});
}

/// Grey levels averaged over blocks of `factor` × `factor` pixels; the remainder at the right and
/// lower sides is dropped.
HalfPixelImage reduced(const Photograph& photograph, int factor, Execution& execution) {
  const int width = photograph.width() / factor;
  const int height = std::max(1, photograph.height() / factor);
  const int rows = std::min(factor, photograph.height());
  const float scale = 1 / (static_cast<float>(factor) * static_cast<float>(rows));
  HalfPixelImage result{{width, height}, {width, height}};
  execution.for_each_band(height, [&](int first_row, int end_row) {
    std::vector<float> grey(static_cast<std::size_t>(photograph.width()));
    std::vector<float> columns(grey.size() + 1);
    const auto mean = [&](int start) {
      return std::accumulate(columns.begin() + start, columns.begin() + start + factor, 0.0F) *
             scale;
    };
    for (int y = first_row; y < end_row; ++y) {
      std::fill(columns.begin(), columns.end(), 0.0F);
      for (int row = 0; row < rows; ++row) {
        intensity_row(photograph, y * factor + row, grey.data());
        std::transform(grey.begin(), grey.end(), columns.begin(), columns.begin(), std::plus<>());
      }
      columns.back() = columns[grey.size() - 1];
      for (int x = 0; x < width; ++x) {
        const int start = x * factor;
        result.at_pixels.row(y)[x] = mean(start);
        const int last = photograph.width() + 1 - factor;
        const int next = std::min(last, start + factor / 2);
        result.between.row(y)[x] =
            (mean(next) + mean(std::min(last, start + (factor + 1) / 2))) / 2;
      }
    }
  });
  return result;
}

/// Search range for reduced images of this width.
DisparityRange search_in(int width) { return {-width / 8, width / 3}; }

/// `range` in images reduced by `factor`.
DisparityRange reduced(DisparityRange range, int factor) {
  return {static_cast<int>(std::lround(static_cast<double>(range.min) / factor)),
          static_cast<int>(std::lround(static_cast<double>(range.max) / factor))};
}

/// Disparities of some regions, in half pixels of the reduced images.
struct Group {
  int min = 0;
  int max = 0;
  double support = 0;
};

/// Result of a search of the reduced images.
struct Agreement {
  int factor = 1;
  DisparityRange search;               ///< in reduced pixels
  std::vector<MatchedRegion> regions;  ///< that count, by their least disparity; may be empty
  std::vector<int> half_pixels;        ///< of all regions, sorted
  double support = 0;                  ///< of all regions
  double pixels = 0;                   ///< of an image

  /// Share of the cells of the left image, from that column of cells on, in which some region lies.
  [[nodiscard]] double seen_share(int first_column) const {
    std::uint64_t cells = 0;
    for (const MatchedRegion& region : regions) {
      cells |= region.cells;
    }
    const std::uint64_t counted = 0x0101010101010101U * ((0xFFU << first_column) & 0xFFU);
    return static_cast<double>(std::popcount(cells & counted)) / std::popcount(counted);
  }
  /// Share of the matches below `half_pixels_end` half pixels; 0 if there are none.
  [[nodiscard]] double share_below(double half_pixels_end) const {
    const auto end = std::lower_bound(half_pixels.begin(), half_pixels.end(), half_pixels_end);
    return static_cast<double>(end - half_pixels.begin()) /
           std::max(1.0, static_cast<double>(half_pixels.size()));
  }
};

/// The span of all groups that are more than chance; `agreement` has regions.
Group span_of(const Agreement& agreement) {
  std::vector<Group> groups;
  for (const MatchedRegion& region : agreement.regions) {
    const int min = region.half_pixels.front();
    const int max = region.half_pixels.back();
    if (groups.empty() || min - groups.back().max > 2 * kGapPx + kGapRatio * std::abs(min)) {
      groups.push_back({min, max, region.support});
    } else {
      groups.back().max = std::max(groups.back().max, max);
      groups.back().support += region.support;
    }
  }
  Group span = *std::max_element(
      groups.begin(), groups.end(),
      [](const Group& one, const Group& other) { return one.support < other.support; });
  for (const Group& group : groups) {
    const bool is_behind = group.min >= 0 && group.max < span.min;
    if (group.support >= (is_behind ? kBehindShare : kApartShare) * agreement.support) {
      span.min = std::min(span.min, group.min);
      span.max = std::max(span.max, group.max);
    }
  }
  return span;
}

Agreement agreement_of(const Photograph& left, const Photograph& right, DisparityRange vertical,
                       Execution& execution) {
  if (left.width() != right.width() || left.height() != right.height()) {
    throw Error(fmt::format("left image is {}x{} but right image is {}x{}, expected equal sizes",
                            left.width(), left.height(), right.width(), right.height()));
  }
  Agreement agreement;
  int& factor = agreement.factor;
  factor = reduction_of(left.width());
  while (factor < left.width() &&
         search_in(left.width() / factor).count() * reduced(vertical, factor).count() >
             kMaxCandidates) {
    ++factor;
  }
  agreement.search = search_in(left.width() / factor);
  const HalfPixelImage left_grey = reduced(left, factor, execution);
  std::vector<MatchedRegion>& regions = agreement.regions;
  regions = find_window_matches(left_grey, reduced(right, factor, execution), agreement.search,
                                reduced(vertical, factor), execution);
  std::erase_if(regions, [](const MatchedRegion& region) { return region.support < kMinSupport; });
  std::sort(regions.begin(), regions.end(),
            [](const MatchedRegion& one, const MatchedRegion& other) {
              return one.half_pixels < other.half_pixels;
            });
  for (const MatchedRegion& region : regions) {
    agreement.support += region.support;
  }
  agreement.pixels =
      static_cast<double>(left_grey.at_pixels.width()) * left_grey.at_pixels.height();
  if (agreement.support < kMinSupportShare * agreement.pixels) {
    regions.clear();
  }
  std::vector<int>& all = agreement.half_pixels;
  for (const MatchedRegion& region : regions) {
    all.insert(all.end(), region.half_pixels.begin(), region.half_pixels.end());
  }
  std::sort(all.begin(), all.end());
  return agreement;
}

}  // namespace

std::optional<DisparityRange> find_disparity_range(const Photograph& left, const Photograph& right,
                                                   Execution& execution, DisparityRange vertical,
                                                   Infinity infinity) {
  const Agreement agreement = agreement_of(left, right, vertical, execution);
  const int factor = agreement.factor;
  if (agreement.regions.empty()) {
    return std::nullopt;
  }
  const Group span = span_of(agreement);
  if (span.max - span.min > 2 * kMaxSpread * agreement.search.count()) {
    return std::nullopt;
  }
  const double min_px = 0.5 * factor * span.min;
  const double max_px = 0.5 * factor * span.max;
  const double unseen = 1 - std::min(1.0, agreement.support / (kFullSupport * agreement.pixels));
  const double margin_px = kMarginPx + (kMarginReducedPx + unseen * kUnseenReducedPx) * factor +
                           (kMarginRatio + unseen * kUnseenRatio) * (max_px - min_px);
  // Where large parts show nothing, far things are behind them or nothing tells. Columns that the
  // right image does not show do not count.
  const int hidden_cells = std::clamp(static_cast<int>(std::ceil(8 * max_px / left.width())), 0, 7);
  const double behind_px = std::max(min_px, 0.0) * (1 - agreement.seen_share(hidden_cells));
  const int farthest = left.width() - 1;
  DisparityRange range{
      std::clamp(static_cast<int>(std::floor(min_px - behind_px - margin_px)), -farthest, farthest),
      std::clamp(static_cast<int>(std::ceil(max_px + margin_px)), -farthest, farthest)};
  if (infinity == Infinity::kAtZero && agreement.share_below(-1) < kNegativeShare) {
    range.min = std::max(range.min, 0);
  }
  return range;
}

DisparityRange require_disparity_range(const std::optional<DisparityRange>& found) {
  if (!found) {
    throw Error(
        "no disparity range can be estimated from the images, expected texture that both show; "
        "give `disparities` MIN:MAX");
  }
  return *found;
}

DisparityRange estimate_disparity_range(const Photograph& left, const Photograph& right,
                                        Execution& execution) {
  return require_disparity_range(find_disparity_range(left, right, execution));
}

DisparitiesBeyond disparities_beyond(const Photograph& left, const Photograph& right,
                                     DisparityRange range, Execution& execution,
                                     DisparityRange vertical) {
  const Agreement agreement = agreement_of(left, right, vertical, execution);
  const double factor = agreement.factor;
  const double tolerance = kMarginPx + kMarginReducedPx * factor;
  const double low = (range.min - tolerance) / factor;
  const double high = (range.max + tolerance) / factor;
  const bool is_known = !agreement.regions.empty();
  return {.below = agreement.share_below(2 * low),
          .above = is_known ? 1 - agreement.share_below(std::floor(2 * high) + 1) : 0,
          .reaches_below = agreement.search.min<low, .reaches_above = agreement.search.max> high};
}

}  // namespace vantage
