#include "engine/sequence/shots/shot_cuts.h"

#include <algorithm>
#include <cstddef>

#include "engine/image/intensity_rows.h"
#include "engine/order_statistics.h"

namespace vantage {
namespace {

constexpr double kUnrelated = 0.3;
constexpr double kStandsOut = 2;
constexpr int kStepsAround = 3;
/// Variance in grey levels² below which there is no content.
constexpr double kNoContent = 25;

/// First pixel of part k of `parts` equal ones, which may be less than a pixel wide.
int part_begin(int k, int parts, int pixels) {
  return std::min(static_cast<int>(static_cast<std::int64_t>(k) * pixels / parts), pixels - 1);
}
int part_end(int k, int parts, int pixels) {
  return std::max(static_cast<int>(static_cast<std::int64_t>(k + 1) * pixels / parts),
                  part_begin(k, parts, pixels) + 1);
}

}  // namespace

Thumbnail make_thumbnail(const Photograph& photograph) {
  constexpr int kWidth = Thumbnail::kWidth;
  constexpr int kHeight = Thumbnail::kHeight;
  const int width = photograph.width();
  const int height = photograph.height();
  Thumbnail thumbnail;
  std::vector<float> grey(static_cast<std::size_t>(width));
  for (int j = 0; j < kHeight; ++j) {
    std::array<double, kWidth> sums = {};
    const int first_row = part_begin(j, kHeight, height);
    const int end_row = part_end(j, kHeight, height);
    for (int y = first_row; y < end_row; ++y) {
      intensity_row(photograph, y, grey.data());
      for (int i = 0; i < kWidth; ++i) {
        for (int x = part_begin(i, kWidth, width); x < part_end(i, kWidth, width); ++x) {
          sums[static_cast<std::size_t>(i)] += grey[static_cast<std::size_t>(x)];
        }
      }
    }
    for (int i = 0; i < kWidth; ++i) {
      const int columns = part_end(i, kWidth, width) - part_begin(i, kWidth, width);
      thumbnail.levels[static_cast<std::size_t>(j * kWidth + i)] = static_cast<float>(
          sums[static_cast<std::size_t>(i)] / (static_cast<double>(end_row - first_row) * columns));
    }
  }
  return thumbnail;
}

double dissimilarity(const Thumbnail& first, const Thumbnail& second) {
  double sum_a = 0;
  double sum_b = 0;
  double squares = 0;   // of both
  double products = 0;  // of each other
  for (std::size_t k = 0; k < first.levels.size(); ++k) {
    const double a = first.levels[k];
    const double b = second.levels[k];
    sum_a += a;
    sum_b += b;
    squares += a * a + b * b;
    products += a * b;
  }
  const auto n = static_cast<double>(first.levels.size());
  const double variances = squares / n - (sum_a * sum_a + sum_b * sum_b) / (n * n);
  const double covariance = products / n - sum_a * sum_b / (n * n);
  return std::max(0.0, (variances - 2 * covariance) / (variances + kNoContent));
}

void ShotCuts::add(const std::optional<Thumbnail>& frame) {
  const auto to = [&](const std::optional<Thumbnail>& other) {
    return frame && other ? static_cast<float>(dissimilarity(*other, *frame)) : 0.0F;
  };
  to_last_.push_back(to(last_[0]));
  to_one_before_.push_back(to(last_[1]));
  last_[1] = last_[0];
  last_[0] = frame;
}

std::vector<int> ShotCuts::shot_starts() const {
  const int frames = static_cast<int>(to_last_.size());
  const auto step = [&](int t) { return double{to_last_[static_cast<std::size_t>(t)]}; };
  const auto long_step = [&](int t) { return double{to_one_before_[static_cast<std::size_t>(t)]}; };
  std::vector<int> starts;
  std::vector<double> around;
  for (int t = 0; t < frames; ++t) {
    if (t > 0) {
      around.clear();
      for (int s = std::max(1, t - kStepsAround); s <= std::min(frames - 1, t + kStepsAround);
           ++s) {
        if (s != t) {
          around.push_back(step(s));
        }
      }
      const bool is_cut = step(t) > kUnrelated &&
                          (around.empty() || step(t) > kStandsOut * upper_median(around)) &&
                          (t < 2 || long_step(t) > kUnrelated) &&
                          (t + 1 == frames || long_step(t + 1) > kUnrelated);
      if (!is_cut) {
        continue;
      }
    }
    starts.push_back(t);
  }
  return starts;
}

}  // namespace vantage
