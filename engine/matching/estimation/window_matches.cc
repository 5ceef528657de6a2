#include "engine/matching/estimation/window_matches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <utility>

namespace vantage {
namespace {

constexpr int kRadius = 2;      ///< of the windows compared
constexpr int kMeanRadius = 3;  ///< of the local means
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

/// Σ over (2·radius + 1)² pixels around each, of those inside the image.
Image<float> window_sums(const Image<float>& image, int radius, Execution& execution) {
  const int width = image.width();
  const int height = image.height();
  Image<float> result(width, height);
  execution.for_each_band(height, [&](int first_row, int end_row) {
    std::vector<float> columns(static_cast<std::size_t>(width + 2 * radius));
    for (int y = first_row; y < end_row; ++y) {
      std::fill(columns.begin(), columns.end(), 0.0F);
      float* const sums = columns.data() + radius;
      for (int row = std::max(0, y - radius); row <= std::min(height - 1, y + radius); ++row) {
        for (int x = 0; x < width; ++x) {
          sums[x] += image.row(row)[x];
        }
      }
      for (int x = 0; x < width; ++x) {
        float sum = 0;
        for (int i = -radius; i <= radius; ++i) {
          sum += sums[x + i];
        }
        result.row(y)[x] = sum;
      }
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
  Detail detail{window_sums(image, kMeanRadius, execution), {}};
  Image<float> squares(width, height);
  const auto inside = [](int at, int size) {
    return std::min(size - 1, at + kMeanRadius) - std::max(0, at - kMeanRadius) + 1;
  };
  execution.for_each_row(height, [&](int y) {
    float* const values = detail.values.row(y);
    for (int x = 0; x < width; ++x) {
      values[x] =
          image.row(y)[x] - values[x] / static_cast<float>(inside(x, width) * inside(y, height));
      squares.row(y)[x] = values[x] * values[x];
    }
  });
  constexpr float kPixels = (2 * kRadius + 1) * (2 * kRadius + 1);
  const float rounding = kRounding * kPixels;
  detail.scale = window_sums(squares, kRadius, execution);
  execution.for_each_row(height, [&](int y) {
    float* const scale = detail.scale.row(y);
    std::transform(scale, scale + width, scale,
                   [&](float energy) { return 1 / std::sqrt(energy + rounding); });
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

/// The search of one row.
class RowSearch {
 public:
  RowSearch(const Detail& reference, const Details& other, DisparityRange columns,
            DisparityRange rows)
      : reference_(reference),
        other_(other),
        half_columns_{2 * columns.min, 2 * columns.max},
        rows_(rows) {
    const auto width = static_cast<std::size_t>(reference.values.width());
    sums_.resize(width + 2 * kRadius);
    for (auto* buffer : {&best_, &second_, &before_, &row_}) {
      buffer->resize(width);
    }
    for (auto& buffer : recent_) {
      buffer.resize(width);
    }
  }

  void run(int y, Winners& winners) {
    const int width = reference_.values.width();
    for (auto* buffer : {&best_, &second_, &before_}) {
      std::fill(buffer->begin(), buffer->end(), -1.0F);
    }
    for (auto& buffer : recent_) {
      std::fill(buffer.begin(), buffer.end(), -1.0F);
    }
    float* const offset = winners.offset.row(y);
    float* const row = winners.row.row(y);
    std::fill_n(offset, width, static_cast<float>(half_columns_.min));
    std::fill_n(row, width, 0.0F);
    for (int d = half_columns_.min; d <= half_columns_.max; ++d) {
      std::vector<float>& correlation =
          recent_[static_cast<std::size_t>(d - half_columns_.min) % recent_.size()];
      // What is forgotten here is too far away to be of the same peak as d.
      std::transform(before_.begin(), before_.end(), correlation.begin(), before_.begin(),
                     [](float a, float b) { return std::max(a, b); });
      std::fill(correlation.begin(), correlation.end(), -1.0F);
      for (int dy = rows_.min; dy <= rows_.max; ++dy) {
        correlate(y, d, dy, correlation);
      }
      for (int x = 0; x < width; ++x) {
        const auto i = static_cast<std::size_t>(x);
        const float r = correlation[i];
        const bool is_better = r > best_[i];
        const bool is_apart = static_cast<float>(d) - offset[x] > kPeakRadius;
        second_[i] = is_better ? before_[i] : is_apart ? std::max(second_[i], r) : second_[i];
        best_[i] = is_better ? r : best_[i];
        offset[x] = is_better ? static_cast<float>(d) : offset[x];
        row[x] = is_better ? row_[i] : row[x];
      }
    }
    for (int x = 0; x < width; ++x) {
      const auto i = static_cast<std::size_t>(x);
      winners.ambiguity.row(y)[x] =
          best_[i] < kMinCorrelation ? 1 : (kInexactness - best_[i]) / (kInexactness - second_[i]);
    }
  }

 private:
  /// Of windows within both images: correlations with the partners half_d / 2 columns
  /// and dy rows away, where they are better.
  void correlate(int y, int half_d, int dy, std::vector<float>& correlation) {
    const int is_between = half_d & 1;
    const int d = (half_d + is_between) / 2;
    const Detail& other = other_[static_cast<std::size_t>(is_between)];
    const int width = reference_.values.width();
    const int height = reference_.values.height();
    const int begin = kRadius + std::max(0, d);
    const int end = std::min(width, width + d) - kRadius;
    if (y - dy < 0 || y - dy >= height || begin >= end) {
      return;
    }
    float* const sums = sums_.data() + kRadius;
    std::fill(sums_.begin(), sums_.end(), 0.0F);
    const int first_row = std::max({0, dy, y - kRadius});
    const int last_row = std::min({height - 1, height - 1 + dy, y + kRadius});
    for (int row = first_row; row <= last_row; ++row) {
      const float* const values = reference_.values.row(row);
      const float* const others = other.values.row(row - dy) - d;
      for (int x = begin - kRadius; x < end + kRadius; ++x) {
        sums[x] += values[x] * others[x];
      }
    }
    const float* const scale = reference_.scale.row(y);
    const float* const other_scale = other.scale.row(y - dy) - d;
    for (int x = begin; x < end; ++x) {
      const float sum = sums[x - 2] + sums[x - 1] + sums[x] + sums[x + 1] + sums[x + 2];
      const float r = sum * scale[x] * other_scale[x];
      const auto i = static_cast<std::size_t>(x);
      row_[i] = r > correlation[i] ? static_cast<float>(dy) : row_[i];
      correlation[i] = std::max(correlation[i], r);
    }
  }

  const Detail& reference_;
  const Details& other_;
  DisparityRange half_columns_;
  DisparityRange rows_;
  std::vector<float> sums_;
  std::vector<float> best_;
  std::vector<float> second_;
  std::vector<float> before_;  ///< the best of all disparities more than kPeakRadius below
  std::vector<float> row_;
  std::array<std::vector<float>, kPeakRadius + 1> recent_;
};

Winners search(const Detail& reference, const Details& other, DisparityRange columns,
               DisparityRange rows, Execution& execution) {
  const int width = reference.values.width();
  const int height = reference.values.height();
  Winners winners{{width, height}, {width, height}, {width, height}};
  execution.for_each_band(height, [&](int first_row, int end_row) {
    RowSearch row_search(reference, other, columns, rows);
    for (int y = first_row; y < end_row; ++y) {
      row_search.run(y, winners);
    }
  });
  return winners;
}

DisparityRange negated(DisparityRange range) { return {-range.max, -range.min}; }

/// Marks as ambiguous what the right image does not confirm.
void check_against(const Winners& right, Winners& left) {
  const int width = left.offset.width();
  for (int y = 0; y < left.offset.height(); ++y) {
    for (int x = 0; x < width; ++x) {
      float& ambiguity = left.ambiguity.row(y)[x];
      if (ambiguity >= kMaxAmbiguity) {
        continue;
      }
      const auto half_d = static_cast<int>(left.offset.row(y)[x]);
      const int partner = x - (half_d + (half_d & 1)) / 2;
      const int row = y - static_cast<int>(left.row.row(y)[x]);
      ambiguity = std::max(ambiguity, right.ambiguity.row(row)[partner]);
      if (std::abs(static_cast<int>(right.offset.row(row)[partner]) + half_d) > kTolerance) {
        ambiguity = 1;
      }
    }
  }
}

/// Takes the pixels of each region out of `winners`.
std::vector<MatchedRegion> regions_of(Winners winners) {
  const int width = winners.offset.width();
  const int height = winners.offset.height();
  std::vector<MatchedRegion> regions;
  std::vector<std::pair<int, int>> open;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      MatchedRegion region;
      const auto take = [&](int px, int py) {
        region.support += 1 - static_cast<double>(winners.ambiguity.row(py)[px] / kMaxAmbiguity);
        region.half_pixels.push_back(static_cast<int>(winners.offset.row(py)[px]));
        winners.ambiguity.row(py)[px] = 1;
        open.emplace_back(px, py);
      };
      if (winners.ambiguity.row(y)[x] < kMaxAmbiguity) {
        take(x, y);
      }
      while (!open.empty()) {
        const auto [at, row] = open.back();
        open.pop_back();
        const float d = winners.offset.row(row)[at];
        for (const auto& [px, py] :
             {std::pair{at - 1, row}, {at + 1, row}, {at, row - 1}, {at, row + 1}}) {
          if (px >= 0 && px < width && py >= 0 && py < height &&
              winners.ambiguity.row(py)[px] < kMaxAmbiguity &&
              std::abs(winners.offset.row(py)[px] - d) <= kTolerance) {
            take(px, py);
          }
        }
      }
      if (!region.half_pixels.empty()) {
        std::sort(region.half_pixels.begin(), region.half_pixels.end());
        regions.push_back(std::move(region));
      }
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
