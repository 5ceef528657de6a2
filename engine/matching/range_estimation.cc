#include "engine/matching/range_estimation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "engine/error.h"
#include "engine/image/intensity_rows.h"
#include "engine/matching/stereo_matcher.h"

namespace vantage {
namespace {

/// Images are reduced by at most this factor as long as they stay at least kMinWidthPx wide, and
/// by more if they would stay wider than kMaxWidthPx. A search takes 1/factor³ of its time on full
/// images, so these determine the cost of the estimate.
constexpr int kUsualFactor = 4;
constexpr int kMinWidthPx = 128;
constexpr int kMaxWidthPx = 320;

// Pixels of the reduced images.
constexpr int kMinRegionPixels = 10;
/// Winners below this confidence are ignored: in uniform areas all disparities are equally likely.
constexpr double kMinConfidence = 0.3;
/// Disparities separated from all others by more than this, plus this fraction of them, are
/// outliers.
constexpr float kGapPx = 2;
constexpr float kGapRatio = 0.1F;
/// Winners of surfaces at infinity are within this of 0.
constexpr float kExactnessPx = 0.4F;

// Shares of the pixels matched in both images.
/// This share at either end may be wrong.
constexpr double kStrayShare = 0.0002;
/// Separate groups count from this share on: repeated texture causes wrong matches in small areas.
/// A group far behind everything else, but not behind infinity, is a mostly hidden background.
constexpr double kApartShare = 0.0025;
constexpr double kBehindShare = 0.0003;
/// A small part of an untextured sky may match at any disparity.
constexpr double kNegativeShare = 0.02;
/// Share of both images; unrelated images agree by chance.
constexpr double kMinMatchedShare = 0.05;

/// Winners spread over a larger part of the search range are random, as with repeated texture.
constexpr double kMaxSpread = 0.75;

/// The range is widened by this plus this fraction of it: winners are accurate to reduced pixels.
constexpr double kMarginReducedPx = 0.5;
constexpr double kMarginPx = 1;
constexpr double kMarginRatio = 0.03;

int reduction_of(int width) {
  const auto parts = [width](int part) { return (width + part - 1) / part; };
  return std::max({1, std::min(kUsualFactor, parts(kMinWidthPx)), parts(kMaxWidthPx)});
}

/// Intensities averaged over blocks of `factor` × `factor` pixels; the remainder at the right and
/// lower sides is dropped.
Photograph reduced(const Photograph& photograph, int factor, Execution& execution) {
  const int width = photograph.width() / factor;
  const int height = std::max(1, photograph.height() / factor);
  const int rows = std::min(factor, photograph.height());
  const float scale =
      1 / (kGreyLevelsPerUnit<float> * static_cast<float>(factor) * static_cast<float>(rows));
  Image<float> result(width, height);
  execution.for_each_band(height, [&](int first_row, int end_row) {
    std::vector<float> grey(static_cast<std::size_t>(photograph.width()));
    for (int y = first_row; y < end_row; ++y) {
      float* sums = result.row(y);
      std::fill_n(sums, width, 0.0F);
      for (int row = 0; row < rows; ++row) {
        intensity_row(photograph, y * factor + row, grey.data());
        const float* block = grey.data();
        for (int x = 0; x < width; ++x, block += factor) {
          for (int column = 0; column < factor; ++column) {
            sums[x] += block[column];
          }
        }
      }
      std::transform(sums, sums + width, sums, [&](float sum) { return sum * scale; });
    }
  });
  return {std::move(result)};
}

/// Search range for reduced images of this width.
DisparityRange search_in(int width) { return {-width / 8, width / 3}; }

/// `range` in images reduced by `factor`.
DisparityRange reduced(DisparityRange range, int factor) {
  return {static_cast<int>(std::lround(static_cast<double>(range.min) / factor)),
          static_cast<int>(std::lround(static_cast<double>(range.max) / factor))};
}

/// Disparities that both images agree on, in pixels of `left` and `right`, sorted.
std::vector<float> agreed_disparities(const Photograph& left, const Photograph& right,
                                      DisparityRange vertical, Execution& execution) {
  MatchOptions options;
  options.preset = MatchPreset::kBalanced;
  options.disparities = search_in(left.width());
  if (vertical != DisparityRange{0, 0}) {
    options.disparities_y = vertical;
  }
  if (options.disparities.count() == 1) {
    return {};  // a single candidate always wins
  }
  options.parameters.levels = 4;  // more suit larger images
  options.refinement.cross_check_level = 0;
  options.refinement.confidence_threshold = kMinConfidence;
  options.refinement.speckle_size_px = kMinRegionPixels;
  options.refinement.surface_fit_px = 0;
  options.refinement.fill = Fill::kNone;
  DisparityMaps maps;
  StereoMatcher(options, execution).match(left, right, {}, maps);
  std::vector<float> values;
  for (const DisparityMap* map : {&maps.left.disparity_px, &maps.right.disparity_px}) {
    for (int y = 0; y < map->height(); ++y) {
      std::copy_if(map->row(y), map->row(y) + map->width(), std::back_inserter(values),
                   [](float d) { return std::isfinite(d); });
    }
  }
  std::sort(values.begin(), values.end());
  return values;
}

struct Span {
  float min = 0;
  float max = 0;
};

/// Span of the sorted values (at least one) without stray ones and small separate groups.
Span span_of(const std::vector<float>& values) {
  const auto count = static_cast<double>(values.size());
  const auto stray = static_cast<std::size_t>(kStrayShare * count);
  std::optional<Span> span;
  for (std::size_t begin = stray; begin + stray < values.size();) {
    std::size_t end = begin + 1;
    while (end + stray < values.size() &&
           values[end] - values[end - 1] <= kGapPx + kGapRatio * std::abs(values[end])) {
      ++end;
    }
    const bool is_behind = !span && values[begin] >= -kExactnessPx;
    if (static_cast<double>(end - begin) >= (is_behind ? kBehindShare : kApartShare) * count) {
      span = Span{span ? span->min : values[begin], values[end - 1]};
    }
    begin = end;
  }
  return span.value_or(Span{values.front(), values.back()});
}

/// Result of a search of the reduced images.
struct Agreement {
  int factor = 1;
  DisparityRange search;      ///< in reduced pixels
  std::vector<float> values;  ///< disparities that both images agree on, in reduced pixels, sorted
  bool says_something = false;
};

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
  agreement.values =
      agreed_disparities(reduced(left, factor, execution), reduced(right, factor, execution),
                         reduced(vertical, factor), execution);
  const double pixels = 2.0 * (left.width() / factor) * std::max(1, left.height() / factor);
  agreement.says_something =
      static_cast<double>(agreement.values.size()) >= std::max(1.0, kMinMatchedShare * pixels);
  return agreement;
}

}  // namespace

std::optional<DisparityRange> find_disparity_range(const Photograph& left, const Photograph& right,
                                                   Execution& execution, DisparityRange vertical,
                                                   Infinity infinity) {
  const Agreement agreement = agreement_of(left, right, vertical, execution);
  const int factor = agreement.factor;
  const std::vector<float>& values = agreement.values;
  if (!agreement.says_something) {
    return std::nullopt;
  }
  const Span span = span_of(values);
  if (span.max - span.min > kMaxSpread * agreement.search.count()) {
    return std::nullopt;
  }
  const double min_px = factor * static_cast<double>(span.min);
  const double max_px = factor * static_cast<double>(span.max);
  const double margin_px = kMarginPx + kMarginReducedPx * factor + kMarginRatio * (max_px - min_px);
  const int farthest = left.width() - 1;
  DisparityRange range{
      std::clamp(static_cast<int>(std::floor(min_px - margin_px)), -farthest, farthest),
      std::clamp(static_cast<int>(std::ceil(max_px + margin_px)), -farthest, farthest)};
  if (infinity == Infinity::kAnywhere) {
    return range;
  }
  // Negative values count only if there are many.
  const auto negative = std::lower_bound(values.begin(), values.end(), -kExactnessPx);
  if (static_cast<double>(negative - values.begin()) <
      kNegativeShare * static_cast<double>(values.size())) {
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
  if (!agreement.says_something) {
    return {};
  }
  const auto factor = static_cast<float>(agreement.factor);
  const auto tolerance = static_cast<float>(kMarginReducedPx) * factor;
  const float low = (static_cast<float>(range.min) - tolerance) / factor;
  const float high = (static_cast<float>(range.max) + tolerance) / factor;
  const std::vector<float>& values = agreement.values;
  const auto count = static_cast<double>(values.size());
  const auto below = std::lower_bound(values.begin(), values.end(), low) - values.begin();
  const auto above = values.end() - std::upper_bound(values.begin(), values.end(), high);
  return {.below = static_cast<double>(below) / count,
          .above = static_cast<double>(above) / count,
          .reaches_below = static_cast<float>(agreement.search.min) < low,
          .reaches_above = static_cast<float>(agreement.search.max) > high};
}

}  // namespace vantage
