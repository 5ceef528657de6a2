#include "engine/refinement/occlusion_consistency.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <span>

#include "engine/refinement/refinement.h"
#include "kernels/filled_median/filled_median.h"
#include "kernels/row_bits/row_bits.h"

namespace vantage {
namespace {

constexpr float kContradictionPx = 1;
// Samples of the medians: farther away than those of filled pixels, because what lies around a
// contradicted pixel is mostly contradicted, too.
constexpr int kCountPerAxis = 7;
constexpr int kStepPx = 6;

/// A row of the other camera's view.
class OtherRow {
 public:
  OtherRow(const OtherCameraView& other, int y)
      : map_px_(other.map_px.row(y)),
        matched_(other.matched.row(y)),
        last_(other.map_px.width() - 1),
        columns_per_px_(static_cast<float>(direction_of(other.side)) * other.columns_per_px) {}

  /// Whether a surface at x with this disparity would hide what the other camera sees.
  [[nodiscard]] bool contradicts(int x, float px) const {
    const float exact = static_cast<float>(x) + columns_per_px_ * px + 0.5F;
    if (!(exact >= 0 && exact < static_cast<float>(last_ + 1))) {  // true for NaN
      return false;
    }
    const int partner = static_cast<int>(exact);
    const auto is_farther = [&](int column) {
      const int inside = std::clamp(column, 0, last_);
      return (matched_[inside / 64] >> (inside % 64) & 1) != 0 &&
             map_px_[inside] < px - kContradictionPx;
    };
    return is_farther(partner) && is_farther(partner - 1) && is_farther(partner + 1);
  }

 private:
  const float* map_px_;
  const std::uint64_t* matched_;
  int last_;
  float columns_per_px_;
};

struct WeightedSample {
  float px = 0;
  std::int32_t weight = 0;
};

/// Calls visit(x) for the marks ≠ 0 of a row, most of which are 0.
template <typename Visit>
void for_each_marked(const std::uint8_t* marks, int width, const Visit& visit) {
  constexpr int kWordBytes = 8;
  for (int begin = 0; begin < width; begin += kWordBytes) {
    const int end = std::min(begin + kWordBytes, width);
    std::uint64_t word = 0;
    std::memcpy(&word, marks + begin, static_cast<std::size_t>(end - begin));
    for (int x = begin; word != 0 && x < end; ++x) {
      if (marks[x] != 0) {
        visit(x);
      }
    }
  }
}

/// The smallest sample such that all samples up to it have at least half of the weight.
float weighted_median(std::span<WeightedSample> samples) {
  std::sort(samples.begin(), samples.end(),
            [](const WeightedSample& a, const WeightedSample& b) { return a.px < b.px; });
  std::int32_t total = 0;
  for (const WeightedSample& sample : samples) {
    total += sample.weight;
  }
  std::int32_t sum = 0;
  for (const WeightedSample& sample : samples) {
    sum += sample.weight;
    if (2 * sum >= total) {
      return sample.px;
    }
  }
  return std::numeric_limits<float>::quiet_NaN();
}

/// Medians of the pixels that are not contradicted.
class ConsistentMedians {
 public:
  ConsistentMedians(const OtherCameraView& other, const FilledMediansWork& medians,
                    const Mask& contradicted, const DisparityMap& map_px)
      : medians_(medians),
        contradicted_(contradicted),
        map_px_(map_px),
        weights_(kernels::filled_median_weights()),
        step_(std::max(1, static_cast<int>(kStepPx * other.columns_per_px))) {}

  /// NaN without any.
  [[nodiscard]] float at(int x, int y, const OtherRow& other) const {
    std::array<WeightedSample, kCountPerAxis * kCountPerAxis> samples;
    std::size_t count = 0;
    constexpr int kReach = kCountPerAxis / 2;
    const std::uint8_t* const own = pixel(x, y);
    for (int j = -kReach; j <= kReach; ++j) {
      const int row = y + j * step_;
      if (row < 0 || row >= map_px_.height()) {
        continue;
      }
      for (int i = -kReach; i <= kReach; ++i) {
        const int column = x + i * step_;
        if (column < 0 || column >= map_px_.width() || contradicted_.at(column, row) != 0) {
          continue;
        }
        const float px = map_px_.at(column, row);
        const std::int32_t weight = weight_of(own, pixel(column, row));
        if (std::isfinite(px) && weight > 0 && !other.contradicts(x, px)) {
          samples[count++] = {px, weight};
        }
      }
    }
    return weighted_median(std::span(samples).first(count));
  }

 private:
  [[nodiscard]] const std::uint8_t* pixel(int x, int y) const {
    return medians_.pixels.row(y + kernels::kFilledMedianReachPx) +
           std::ptrdiff_t{kernels::kFilledPixelBytes} * (x + kernels::kFilledMedianMarginPx);
  }

  [[nodiscard]] std::int32_t weight_of(const std::uint8_t* a, const std::uint8_t* b) const {
    const int difference = std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
    return weights_[static_cast<std::size_t>(difference)];
  }

  const FilledMediansWork& medians_;
  const Mask& contradicted_;
  const DisparityMap& map_px_;
  const kernels::FilledMedianWeights& weights_;
  int step_;
};

}  // namespace

void keep_matched(ImageView<const float> map_px, double tolerance_px, Execution& execution,
                  Mask& unmatched, OtherCameraView& other) {
  const int width = map_px.width();
  cross_check(other.map_px, map_px, other_side(other.side), tolerance_px, execution, unmatched,
              other.columns_per_px);
  other.matched.resize(kernels::row_words(width), map_px.height());
  execution.for_each_row(map_px.height(), [&](int y) {
    kernels::zero_bits_row(unmatched.row(y), width, other.matched.row(y));
  });
}

void mend_contradicted(const Mask& unmatched, const OtherCameraView& other,
                       const FilledMediansWork& medians, Execution& execution, Mask& contradicted,
                       DisparityMap& map_px) {
  const int width = map_px.width();
  contradicted.resize(width, map_px.height());
  execution.for_each_row(map_px.height(), [&](int y) {
    const OtherRow row(other, y);
    std::fill_n(contradicted.row(y), width, std::uint8_t{0});
    for_each_marked(unmatched.row(y), width, [&](int x) {
      contradicted.at(x, y) = row.contradicts(x, map_px.at(x, y)) ? 255 : 0;
    });
  });
  // Contradicted pixels are written, all others are read.
  const ConsistentMedians consistent(other, medians, contradicted, map_px);
  execution.for_each_row(map_px.height(), [&](int y) {
    const OtherRow row(other, y);
    for_each_marked(contradicted.row(y), width, [&](int x) {
      const float median_px = consistent.at(x, y, row);
      map_px.at(x, y) = std::isfinite(median_px) ? median_px : map_px.at(x, y);
    });
  });
}

}  // namespace vantage
