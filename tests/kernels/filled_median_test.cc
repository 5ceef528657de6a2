#include "kernels/filled_median/filled_median.h"

#include <bit>
#include <map>
#include <utility>

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::filled_median_test {

constexpr std::size_t kColours = 3;
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

struct Filled {
  int width = 0;
  int height = 0;
  std::vector<float> disparity_px;
  std::vector<std::uint8_t> pixels;  ///< [place · kColours + c]
  std::vector<std::uint8_t> unmatched;

  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y * width + x);
  }
};

/// What the kernel makes of a map, which it gets with margins that end where it may read no
/// further.
std::vector<float> medians(const Filled& map) {
  constexpr int kReach = kFilledMedianReachPx;
  const int pitch = kFilledMedianMarginPx + map.width + kFilledMedianMarginPx;
  const auto size = static_cast<std::size_t>(pitch * (kReach + map.height + kReach));
  UnalignedRow<float> disparity_px(size, 1);
  UnalignedRow<std::uint8_t> pixels(size * kFilledPixelBytes, 3);
  std::fill_n(disparity_px.data(), size, kUnknown);
  std::mt19937 random(7);
  std::generate_n(pixels.data(), pixels.size(),
                  [&] { return static_cast<std::uint8_t>(random() % 256); });
  const auto place = [&](int x, int y) {
    return static_cast<std::size_t>((kReach + y) * pitch + kFilledMedianMarginPx + x);
  };
  for (std::size_t i = 0; i < size; ++i) {
    pixels[i * kFilledPixelBytes + 3] = 0;
  }
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      disparity_px[place(x, y)] = map.disparity_px[map.at(x, y)];
      std::copy_n(map.pixels.data() + map.at(x, y) * kColours, kColours,
                  pixels.data() + place(x, y) * kFilledPixelBytes);
    }
  }
  std::vector<float> result;
  for (int y = 0; y < map.height; ++y) {
    const auto width = static_cast<std::size_t>(map.width);
    UnalignedRow<std::uint8_t> unmatched(width, 1);
    std::copy_n(map.unmatched.data() + map.at(0, y), map.width, unmatched.data());
    GuardedRow<float> row(width, 1, -77);
    std::copy_n(map.disparity_px.data() + map.at(0, y), map.width, row.data());
    take_filled_medians_row({.disparity_px = disparity_px.data() + place(0, y),
                             .disparity_pitch = pitch,
                             .pixels = pixels.data() + place(0, y) * kFilledPixelBytes,
                             .pixel_pitch = pitch * kFilledPixelBytes,
                             .unmatched = unmatched.data(),
                             .width = map.width},
                            row.data());
    EXPECT_TRUE(row.intact());
    const std::vector<float> values = row.values();
    result.insert(result.end(), values.begin(), values.end());
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
      for (std::size_t c = 0; c < kColours; ++c) {
        difference += std::abs(map.pixels[map.at(u, v) * kColours + c] -
                               map.pixels[map.at(x, y) * kColours + c]);
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
      return disparity_px == 0 ? 0 : disparity_px;
    }
  }
  return own;
}

void expect_equal_bits(const std::vector<float>& result, const std::vector<float>& expected,
                       const std::string& what) {
  ASSERT_EQ(result.size(), expected.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    ASSERT_EQ(std::bit_cast<std::uint32_t>(result[i]), std::bit_cast<std::uint32_t>(expected[i]))
        << what << " at " << i << ": " << result[i] << " instead of " << expected[i];
  }
}

/// The kernel against the transcription.
void expect_contract(const Filled& map, const std::string& what) {
  std::vector<float> expected;
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      expected.push_back(expected_at(map, x, y));
    }
  }
  expect_equal_bits(medians(map), expected, what);
}

/// Disparities that make_value() gives, colours with `levels` levels a channel, and `unmatched` in
/// eight pixels filled.
template <class MakeValue>
Filled random_map(std::mt19937& random, int width, int height, unsigned levels, unsigned unmatched,
                  const MakeValue& make_value) {
  Filled map{width, height, {}, {}, {}};
  for (int i = 0; i < width * height; ++i) {
    map.disparity_px.push_back(make_value());
    for (std::size_t c = 0; c < kColours; ++c) {
      map.pixels.push_back(static_cast<std::uint8_t>(random() % levels));
    }
    map.unmatched.push_back(random() % 8 < unmatched ? static_cast<std::uint8_t>(1 + random() % 255)
                                                     : 0);
  }
  return map;
}

constexpr std::pair<int, int> kSizes[] = {{1, 1},   {1, 37},  {53, 1},  {2, 3},
                                          {4, 5},   {5, 4},   {13, 13}, {16, 11},
                                          {17, 12}, {31, 29}, {67, 41}, {101, 7}};

VANTAGE_ON_EVERY_TARGET(FilledMedian);

TEST_P(FilledMedian, EqualsPlainTranscription) {
  std::mt19937 random(5);
  for (const auto& [width, height] : kSizes) {
    for (const unsigned levels : {1U, 3U, 40U, 256U}) {
      for (const unsigned unmatched : {0U, 1U, 5U, 8U}) {
        const Filled map = random_map(random, width, height, levels, unmatched, [&] {
          // How many different ones there are follows the levels too.
          return random() % 8 == 0 ? kUnknown : static_cast<float>(random() % (2 * levels)) / 4 - 8;
        });
        expect_contract(map, std::to_string(width) + "x" + std::to_string(height) + ", " +
                                 std::to_string(levels) + " levels, " + std::to_string(unmatched) +
                                 "/8 unmatched");
      }
    }
  }
}

TEST_P(FilledMedian, TakesAnyValues) {
  // Where the middle of two is neither between them nor a number, or zeros differ in sign.
  constexpr float kMax = std::numeric_limits<float>::max();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const float above_one = std::nextafter(1.0F, 2.0F);
  const std::vector<std::vector<float>> kinds = {
      {2.5F},
      {kUnknown},
      {kInfinity},
      {-kInfinity},
      {0.0F, -0.0F},
      {-0.0F},
      {-0.0F, 1, kUnknown},
      {1, above_one, std::nextafter(above_one, 2.0F)},
      {kInfinity, -kInfinity, kUnknown},
      {kInfinity, -kInfinity, 3, -0.0F, 0.0F, kMax, -kMax, 1e-30F},
      {kMax, std::nextafter(kMax, 0.0F), -kMax},
      {0, 1, 2, 4, 8, 16, 1e3F, 1e6F, 1e9F, 1e12F, 1e15F, 1e18F, 1e21F, 1e24F, 1e27F, 1e30F}};
  std::mt19937 random(8);
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    const Filled map = random_map(random, 37, 23, 30, 6,
                                  [&] { return kinds[kind][random() % kinds[kind].size()]; });
    expect_contract(map, "values of kind " + std::to_string(kind));
  }
}

TEST(FilledMedianWeights, FallWithTheDifference) {
  const FilledMedianWeights& weights = filled_median_weights();
  for (std::size_t sum = 0; sum < weights.size(); ++sum) {
    EXPECT_EQ(weights[sum],
              std::llround(4096 * std::exp(-static_cast<double>(sum) / kFilledMedianLevels)));
  }
}

/// A sample of disparity 1 against others of disparity 2 that weigh as much, or one more.
TEST_P(FilledMedian, WeighsSamplesExactly) {
  const FilledMedianWeights& weights = filled_median_weights();
  constexpr int kSize = 2 * kFilledMedianReachPx + 1;
  const auto median_against = [&](std::size_t difference, int others) {
    Filled map{kSize, kSize, {}, {}, {}};
    map.disparity_px.assign(kSize * kSize, kUnknown);
    map.pixels.assign(kColours * kSize * kSize, 0);
    map.unmatched.assign(kSize * kSize, 0);
    map.unmatched[map.at(kFilledMedianReachPx, kFilledMedianReachPx)] = 255;
    int samples = 0;
    const auto add = [&](float disparity_px, std::size_t of_sample) {
      const std::size_t at = map.at(samples % kFilledMedianSamples * kFilledMedianStepPx,
                                    samples / kFilledMedianSamples * kFilledMedianStepPx);
      map.disparity_px[at] = disparity_px;
      for (std::size_t c = 0; c < kColours; ++c) {
        const std::size_t of_channel = std::min(of_sample, std::size_t{255});
        map.pixels[at * kColours + c] = static_cast<std::uint8_t>(of_channel);
        of_sample -= of_channel;
      }
      ++samples;
    };
    add(1, difference);
    for (std::size_t next = 0; others > 0; others -= weights[next]) {
      while (weights[next] > others) {
        ++next;
      }
      add(2, next);
    }
    EXPECT_LT(samples, kFilledMedianSamples * kFilledMedianSamples / 2);  // before the pixel
    return medians(map)[map.at(kFilledMedianReachPx, kFilledMedianReachPx)];
  };
  for (std::size_t difference = 0; weights[difference] > 0; ++difference) {
    EXPECT_EQ(median_against(difference, weights[difference]), 1) << difference;
    EXPECT_EQ(median_against(difference, weights[difference] + 1), 2) << difference;
  }
}

TEST_P(FilledMedian, FollowsWhatLooksLikeThePixel) {
  // A dark surface of disparity 9 in front of a bright one of 2, both with noise. A row of the dark
  // one was filled with the background's disparity, a row of the bright one with the foreground's.
  constexpr int kSize = 40;
  constexpr int kOutline = 20;
  std::mt19937 random(6);
  Filled map{kSize, kSize, {}, {}, {}};
  for (int i = 0; i < kSize * kSize; ++i) {
    const bool is_front = i % kSize >= kOutline;
    map.disparity_px.push_back(is_front ? 9 : 2);
    map.pixels.insert(map.pixels.end(), kColours,
                      static_cast<std::uint8_t>((is_front ? 40 : 180) + random() % 20));
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

TEST_P(FilledMedian, KeepsPixelsThatNothingIsKnownAround) {
  const Filled map{
      3, 1, {kUnknown, kUnknown, kUnknown}, {1, 1, 1, 2, 2, 2, 3, 3, 3}, {255, 255, 255}};
  for (const float value : medians(map)) {
    EXPECT_TRUE(std::isnan(value));
  }
}

}  // namespace vantage::kernels::filled_median_test
