#include "kernels/filled_median/filled_median.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <random>
#include <utility>
#include <vector>

namespace vantage::kernels {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

struct Filled {
  int width = 0;
  int height = 0;
  int channels = 1;
  std::vector<float> disparity_px;
  std::vector<std::uint8_t> pixels;
  std::vector<std::uint8_t> unmatched;

  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y * width + x);
  }
};

std::vector<float> medians(const Filled& map) {
  std::vector<float> result = map.disparity_px;
  for (int y = 0; y < map.height; ++y) {
    take_filled_medians_row(
        {.disparity_px = map.disparity_px.data() + map.at(0, y),
         .disparity_pitch = map.width,
         .pixels = map.pixels.data() + map.at(0, y) * static_cast<std::size_t>(map.channels),
         .pixel_pitch = map.width * map.channels,
         .channels = map.channels,
         .unmatched = map.unmatched.data() + map.at(0, y),
         .width = map.width,
         .rows_above = y,
         .rows_below = map.height - 1 - y},
        result.data() + map.at(0, y));
  }
  return result;
}

/// The contract for one pixel: weights per disparity in order, until half of them are reached.
float expected_at(const Filled& map, int x, int y) {
  const float own = map.disparity_px[map.at(x, y)];
  if (map.unmatched[map.at(x, y)] == 0) {
    return own;
  }
  constexpr int kHalf = kFilledMedianSamples / 2;
  std::map<float, std::int64_t> weights;
  std::int64_t total = 0;
  for (int j = -kHalf; j <= kHalf; ++j) {
    for (int i = -kHalf; i <= kHalf; ++i) {
      const int u = x + i * kFilledMedianStepPx;
      const int v = y + j * kFilledMedianStepPx;
      if (u < 0 || u >= map.width || v < 0 || v >= map.height ||
          std::isnan(map.disparity_px[map.at(u, v)])) {
        continue;
      }
      double difference = 0;
      const int colours = std::min(map.channels, 3);
      for (std::size_t c = 0; c < static_cast<std::size_t>(colours); ++c) {
        const auto channels = static_cast<std::size_t>(map.channels);
        difference += std::abs(map.pixels[map.at(u, v) * channels + c] -
                               map.pixels[map.at(x, y) * channels + c]) *
                      3.0 / colours;
      }
      const auto weight = std::llround(4096 * std::exp(-difference / kFilledMedianLevels));
      if (weight > 0) {
        weights[map.disparity_px[map.at(u, v)]] += weight;
        total += weight;
      }
    }
  }
  std::int64_t reached = 0;
  for (const auto& [disparity_px, weight] : weights) {
    reached += weight;
    if (2 * reached >= total) {
      return disparity_px;
    }
  }
  return own;
}

TEST(FilledMedian, EqualsPlainTranscription) {
  std::mt19937 random(5);
  for (const auto& [width, height] :
       {std::pair{1, 1}, {1, 37}, {53, 1}, {4, 5}, {5, 4}, {13, 13}, {31, 29}, {67, 41}}) {
    for (const unsigned levels : {1U, 3U, 40U, 256U}) {  // how many different ones there are
      Filled map{width, height, levels == 3 ? 1 : levels == 40 ? 4 : 3, {}, {}, {}};
      for (int i = 0; i < width * height; ++i) {
        const unsigned kind = random() % 8;
        map.disparity_px.push_back(kind == 0 ? kUnknown
                                             : static_cast<float>(random() % (2 * levels)) / 4 - 8);
        for (int c = 0; c < map.channels; ++c) {
          map.pixels.push_back(static_cast<std::uint8_t>(random() % levels));
        }
        map.unmatched.push_back(random() % 3 == 0 ? 0 : static_cast<std::uint8_t>(random() % 256));
      }
      const std::vector<float> result = medians(map);
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          ASSERT_EQ(std::bit_cast<std::uint32_t>(result[map.at(x, y)]),
                    std::bit_cast<std::uint32_t>(expected_at(map, x, y)))
              << width << "x" << height << ", " << levels << " levels at " << x << ", " << y;
        }
      }
    }
  }
}

TEST(FilledMedian, FollowsWhatLooksLikeThePixel) {
  // A dark surface of disparity 9 in front of a bright one of 2, both with noise. A row of the dark
  // one was filled with the background's disparity, a row of the bright one with the foreground's.
  constexpr int kSize = 40;
  constexpr int kOutline = 20;
  std::mt19937 random(6);
  Filled map{kSize, kSize, 1, {}, {}, {}};
  for (int i = 0; i < kSize * kSize; ++i) {
    const bool is_front = i % kSize >= kOutline;
    map.disparity_px.push_back(is_front ? 9 : 2);
    map.pixels.push_back(static_cast<std::uint8_t>((is_front ? 40 : 180) + random() % 20));
    map.unmatched.push_back(0);
  }
  const Filled right = map;
  for (const int y : {13, 14, 26}) {
    for (int x = 15; x < 25; ++x) {
      map.unmatched[map.at(x, y)] = 255;
      map.disparity_px[map.at(x, y)] = y == 26 ? 9 : 2;
    }
  }
  EXPECT_EQ(medians(map), right.disparity_px);
}

TEST(FilledMedian, KeepsPixelsThatNothingIsKnownAround) {
  const Filled map{3, 1, 1, {kUnknown, kUnknown, kUnknown}, {1, 2, 3}, {255, 255, 255}};
  for (const float value : medians(map)) {
    EXPECT_TRUE(std::isnan(value));
  }
}

}  // namespace
}  // namespace vantage::kernels
