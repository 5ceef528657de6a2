#include "engine/matching/estimation/window_matches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <utility>

#include "kernels/window_correlation/window_correlation.h"

namespace vantage {
namespace {

// Windows are narrow, so that they fit between bars and on surfaces seen from the side.
constexpr int kRadius = 1;      ///< of the windows compared, columns
constexpr int kMeanRadius = 3;  ///< of the local means, columns
constexpr int kRowRadius = 3;   ///< of both
static_assert(kRadius == 1 && 2 * kRowRadius + 1 == kernels::kCorrelationRows);
/// Columns at the sides whose means lack pixels: they resemble only what is at the same place.
constexpr int kBorder = kRadius + kMeanRadius;
/// Variance, in grey levels², that is added to that of each image: of rounding to whole levels.
constexpr float kRounding = 0.005F;
/// Texture has more than three times the variance of the noise then.
constexpr float kMinCorrelation = 0.75F;
// Half pixels.
constexpr int kPeakRadius = 4;  ///< disparities this near belong to the same peak
constexpr int kTolerance = 2;   ///< between neighbours, and between both images
/// (c − r₁)/(c − r₂) of a match that is unique; c above 1, as equal ones differ a little.
constexpr float kInexactness = 1.02F;
constexpr float kMaxAmbiguity = 0.6F;

/// Σ over windows of 2·radius + 1 columns, of the pixels inside the image.
Image<float> window_sums(const Image<float>& image, int radius, Execution& execution) {
  const int width = image.width();
  Image<float> result(width, image.height());
  execution.for_each_row(image.height(), [&](int y) {
    std::vector<float> columns(static_cast<std::size_t>(width + 2 * radius));
    float* const sums = columns.data() + radius;
    const int last_row = std::min(image.height() - 1, y + kRowRadius);
    for (int row = std::max(0, y - kRowRadius); row <= last_row; ++row) {
      std::transform(sums, sums + width, image.row(row), sums, std::plus<>());
    }
    for (int x = 0; x < width; ++x) {
      result.row(y)[x] = std::accumulate(sums + x - radius, sums + x + radius + 1, 0.0F);
    }
  });
  return result;
}

/// An image prepared for correlations.
struct Detail {
  Image<float> values;  ///< minus local means
  Image<float> scale;   ///< 1/√(Σ values² + rounding) of the window around each pixel
};

Detail detail_of(const Image<float>& image, Execution& execution) {
  const int width = image.width();
  const int height = image.height();
  Image<float> ones(width, height);
  ones.fill(1);
  const Image<float> pixels = window_sums(ones, kMeanRadius, execution);
  Detail detail{window_sums(image, kMeanRadius, execution), {}};
  Image<float> squares(width, height);
  execution.for_each_row(height, [&](int y) {
    float* const values = detail.values.row(y);
    for (int x = 0; x < width; ++x) {
      values[x] = image.row(y)[x] - values[x] / pixels.row(y)[x];
      squares.row(y)[x] = values[x] * values[x];
    }
  });
  constexpr float kPixels = (2 * kRadius + 1) * (2 * kRowRadius + 1);
  detail.scale = window_sums(squares, kRadius, execution);
  execution.for_each_row(height, [&](int y) {
    float* const scale = detail.scale.row(y);
    std::transform(scale, scale + width, scale,
                   [](float energy) { return 1 / std::sqrt(energy + kRounding * kPixels); });
  });
  return detail;
}

/// The same at pixels and between.
using Details = std::array<Detail, 2>;

/// What a search finds for each pixel of its reference.
struct Winners {
  Image<float> offset;     ///< 2(x − x') of the best partner (x', y')
  Image<float> row;        ///< y − y'
  Image<float> ambiguity;  ///< (c − r₁)/(c − r₂); 1 where r₁ is too small
};

/// Correlations of row y with partners half_d / 2 columns and dy rows away, of windows inside both
/// images, where they are better than `best`; then `row` becomes dy.
void correlate(const Detail& reference, const Details& others, int y, int half_d, int dy,
               float* best, float* row, std::vector<float>& columns) {
  const int width = reference.values.width();
  const int height = reference.values.height();
  const int is_between = half_d & 1;
  const int d = (half_d + is_between) / 2;
  const Detail& other = others[static_cast<std::size_t>(is_between)];
  const int begin = kBorder + std::max(0, d);
  const int end = std::min(width, width + d) - kBorder;
  if (y - dy < 0 || y - dy >= height || begin >= end) {
    return;
  }
  kernels::CorrelationRow rows{.scale = reference.scale.row(y),
                               .partner_scale = other.scale.row(y - dy) - d,
                               .begin = begin,
                               .end = end,
                               .sums = columns.data()};
  const int last_row = std::min({height - 1, height - 1 + dy, y + kRowRadius});
  for (int from = std::max({0, dy, y - kRowRadius}); from <= last_row; ++from) {
    rows.values[static_cast<std::size_t>(rows.rows)] = reference.values.row(from);
    rows.partners[static_cast<std::size_t>(rows.rows)] = other.values.row(from - dy) - d;
    ++rows.rows;
  }
  kernels::correlation_row(rows, static_cast<float>(dy), best, row);
}

Winners search(const Detail& reference, const Details& other, DisparityRange columns,
               DisparityRange rows, Execution& execution) {
  const int width = reference.values.width();
  const int height = reference.values.height();
  Winners winners{{width, height}, {width, height}, {width, height}};
  execution.for_each_row(height, [&](int y) {
    const std::vector<float> none(static_cast<std::size_t>(width), -1.0F);
    std::array<std::vector<float>, kPeakRadius + 1> recent;
    recent.fill(none);
    std::vector<float> best = none;
    std::vector<float> second = none;
    std::vector<float> before = none;  // the best of all disparities that are not recent
    std::vector<float> partner_row = none;
    std::vector<float> sums = none;
    float* const offset = winners.offset.row(y);
    float* const row = winners.row.row(y);
    std::fill_n(offset, width, 2.0F * static_cast<float>(columns.min));
    std::fill_n(row, width, 0.0F);
    for (int half_d = 2 * columns.min; half_d <= 2 * columns.max; ++half_d) {
      std::vector<float>& now =
          recent[static_cast<std::size_t>(half_d - 2 * columns.min) % recent.size()];
      std::transform(before.begin(), before.end(), now.begin(), before.begin(),
                     [](float a, float b) { return std::max(a, b); });
      now = none;
      for (int dy = rows.min; dy <= rows.max; ++dy) {
        correlate(reference, other, y, half_d, dy, now.data(), partner_row.data(), sums);
      }
      kernels::add_partners_row(now.data(), partner_row.data(), before.data(),
                                static_cast<float>(half_d), kPeakRadius, width,
                                {best.data(), second.data(), offset, row});
    }
    std::transform(best.begin(), best.end(), second.begin(), winners.ambiguity.row(y),
                   [](float r1, float r2) {
                     return r1 < kMinCorrelation ? 1 : (kInexactness - r1) / (kInexactness - r2);
                   });
  });
  return winners;
}

DisparityRange negated(DisparityRange range) { return {-range.max, -range.min}; }

/// Marks as ambiguous what the right image does not confirm.
void check_against(const Winners& right, Winners& left) {
  for (int y = 0; y < left.offset.height(); ++y) {
    for (int x = 0; x < left.offset.width(); ++x) {
      float& ambiguity = left.ambiguity.row(y)[x];
      if (ambiguity >= kMaxAmbiguity) {
        continue;
      }
      const auto half_d = static_cast<int>(left.offset.row(y)[x]);
      const int partner = x - (half_d + (half_d & 1)) / 2;
      const int row = y - static_cast<int>(left.row.row(y)[x]);
      const bool agrees =
          std::abs(static_cast<int>(right.offset.row(row)[partner]) + half_d) <= kTolerance;
      ambiguity = agrees ? std::max(ambiguity, right.ambiguity.row(row)[partner]) : 1;
    }
  }
}

/// Takes the pixels of each region out of `winners`.
std::vector<MatchedRegion> regions_of(Winners winners) {
  const int width = winners.offset.width();
  const int height = winners.offset.height();
  const auto is_match = [&](int x, int y) {
    return x >= 0 && x < width && y >= 0 && y < height &&
           winners.ambiguity.row(y)[x] < kMaxAmbiguity;
  };
  std::vector<MatchedRegion> regions;
  std::vector<std::pair<int, int>> open;
  const auto take = [&](int x, int y) {
    float& ambiguity = winners.ambiguity.row(y)[x];
    regions.back().support += 1 - static_cast<double>(ambiguity / kMaxAmbiguity);
    regions.back().half_pixels.push_back(static_cast<int>(winners.offset.row(y)[x]));
    regions.back().cells |= std::uint64_t{1} << (8 * (8 * y / height) + 8 * x / width);
    ambiguity = 1;
    open.emplace_back(x, y);
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (!is_match(x, y)) {
        continue;
      }
      regions.emplace_back();
      take(x, y);
      while (!open.empty()) {
        const auto [at, row] = open.back();
        open.pop_back();
        const float offset = winners.offset.row(row)[at];
        for (const auto& [px, py] :
             {std::pair{at - 1, row}, {at + 1, row}, {at, row - 1}, {at, row + 1}}) {
          if (is_match(px, py) && std::abs(winners.offset.row(py)[px] - offset) <= kTolerance) {
            take(px, py);
          }
        }
      }
      std::sort(regions.back().half_pixels.begin(), regions.back().half_pixels.end());
    }
  }
  return regions;
}

}  // namespace

std::vector<MatchedRegion> find_window_matches(const HalfPixelImage& left,
                                               const HalfPixelImage& right, DisparityRange columns,
                                               DisparityRange rows, Execution& execution) {
  const Details lefts{detail_of(left.at_pixels, execution), detail_of(left.between, execution)};
  const Details rights{detail_of(right.at_pixels, execution), detail_of(right.between, execution)};
  Winners winners = search(lefts[0], rights, columns, rows, execution);
  check_against(search(rights[0], lefts, negated(columns), negated(rows), execution), winners);
  return regions_of(std::move(winners));
}

}  // namespace vantage
