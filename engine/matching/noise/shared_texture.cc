#include "engine/matching/noise/shared_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/image/intensity_rows.h"

namespace vantage {
namespace {

constexpr int kRowsBeside = 1;

/// Second differences of rows [y_begin, y_begin + count); 0 in the first and last column.
std::vector<std::vector<float>> difference_rows(const Photograph& photograph, int y_begin,
                                                int count) {
  const auto width = static_cast<std::size_t>(photograph.width());
  std::vector<std::vector<float>> grey;
  for (int y = y_begin - 1; y <= y_begin + count; ++y) {
    grey.emplace_back(width);
    intensity_row(photograph, std::clamp(y, 0, photograph.height() - 1), grey.back().data());
  }
  std::vector<std::vector<float>> rows;
  for (std::size_t i = 1; i + 1 < grey.size(); ++i) {
    rows.emplace_back(width, 0.0F);
    for (int x = 1; x + 1 < photograph.width(); ++x) {
      rows.back()[static_cast<std::size_t>(x)] =
          second_difference(grey[i - 1].data(), grey[i].data(), grey[i + 1].data(), x);
    }
  }
  return rows;
}

/// The largest correlation of the block with one of the right image.
double best_correlation(const Photograph& left, const Photograph& right, BlockPlace block,
                        DisparityRange disparities) {
  const auto own = difference_rows(left, block.y, kNoiseBlockPx);
  const auto others =
      difference_rows(right, block.y - kRowsBeside, kNoiseBlockPx + 2 * kRowsBeside);
  double best = 0;
  const int first = std::max(1, block.x - disparities.max);
  const int last = std::min(right.width() - 1 - kNoiseBlockPx, block.x - disparities.min);
  for (std::size_t shift = 0; shift <= 2 * kRowsBeside; ++shift) {
    for (int begin = first; begin <= last; ++begin) {
      float product = 0;
      float of_own = 0;
      float of_other = 0;
      for (std::size_t y = 0; y < kNoiseBlockPx; ++y) {
        const float* a = own[y].data() + block.x;
        const float* b = others[y + shift].data() + begin;
        for (int x = 0; x < kNoiseBlockPx; ++x) {
          product += a[x] * b[x];
          of_own += a[x] * a[x];
          of_other += b[x] * b[x];
        }
      }
      if (product > 0) {
        best = std::max(best, product / std::sqrt(static_cast<double>(of_own) * of_other));
      }
    }
  }
  return best;
}

}  // namespace

bool is_shared_texture(const Photograph& left, const Photograph& right,
                       std::span<const BlockPlace> blocks, DisparityRange disparities) {
  // The best of 200 chance matches of 64 pixels is about 0.5; texture between pixels reaches 0.8.
  constexpr double kFoundAgain = 0.65;
  std::vector<double> correlations;
  for (const BlockPlace& block : blocks) {
    correlations.push_back(best_correlation(left, right, block, disparities));
  }
  const auto middle = correlations.begin() + static_cast<std::ptrdiff_t>(correlations.size() / 2);
  std::ranges::nth_element(correlations, middle);
  return !correlations.empty() && *middle > kFoundAgain;
}

}  // namespace vantage
