#include "kernels/flicker_sums/flicker_sums.h"

#include <cstdlib>

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::flicker_sums_test {

constexpr int kWidths[] = {1, 2, 3, 15, 16, 17, 64, 65, 1023, 1024, 1025, 20000};

std::vector<std::uint8_t> random_bytes(std::mt19937& random, int width) {
  std::vector<std::uint8_t> bytes(width);
  for (std::uint8_t& byte : bytes) {
    byte = static_cast<std::uint8_t>(random());
  }
  return bytes;
}

std::vector<std::uint8_t> random_mask(std::mt19937& random, int width) {
  std::vector<std::uint8_t> mask(width);
  for (std::uint8_t& value : mask) {
    value = random() % 4 == 0 ? 0 : 255;
  }
  return mask;
}

VANTAGE_ON_EVERY_TARGET(FlickerSumsKernel);

TEST_P(FlickerSumsKernel, DisparityChange) {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  std::mt19937 random(76);
  for (const int width : kWidths) {
    // Large differences everywhere must not overflow.
    for (const bool extreme : {false, true}) {
      UnalignedRow<float> now(width, random() % 5);
      UnalignedRow<float> before(width, random() % 5);
      for (std::size_t x = 0; x < now.size(); ++x) {
        now[x] = random() % 9 == 0 ? kUnknown : static_cast<float>(random() % 4000) / 64 - 20;
        before[x] = random() % 9 == 0   ? kUnknown
                    : random() % 3 == 0 ? now[x] + 1
                                        : now[x] + static_cast<float>(random() % 999) / 300;
        if (extreme) {
          now[x] = -2000;
          before[x] = 3000;
        }
      }
      const auto mask = random_mask(random, width);
      const auto actual = disparity_change_row(now.data(), before.data(), mask.data(), width);
      const auto reference =
          disparity_change_row_ref(now.data(), before.data(), mask.data(), width);
      std::int64_t compared = 0;
      std::int64_t jumped = 0;
      double change = 0;
      double min = std::numeric_limits<double>::infinity();
      double max = -min;
      for (std::size_t x = 0; x < now.size(); ++x) {
        for (const float d : {now[x], before[x]}) {
          min = std::isnan(d) ? min : std::min<double>(min, d);
          max = std::isnan(d) ? max : std::max<double>(max, d);
        }
        if (mask[x] != 0 && !std::isnan(now[x]) && !std::isnan(before[x])) {
          ++compared;
          jumped += std::abs(now[x] - before[x]) > 1 ? 1 : 0;
          change += std::min(1024.0, std::abs(double{now[x]} - before[x]));
        }
      }
      for (const DisparityChange& sums : {actual, reference}) {
        ASSERT_EQ(sums.compared, compared);
        ASSERT_EQ(sums.jumped, jumped);
        ASSERT_NEAR(static_cast<double>(sums.change), change * 1024,
                    static_cast<double>(compared) / 2);
        ASSERT_EQ(sums.min_px, static_cast<float>(min));
        ASSERT_EQ(sums.max_px, static_cast<float>(max));
      }
      ASSERT_EQ(actual.change, reference.change);
    }
  }
}

TEST_P(FlickerSumsKernel, IntensityChangeAndSum) {
  std::mt19937 random(77);
  for (const int width : kWidths) {
    for (const bool extreme : {false, true}) {
      auto now = random_bytes(random, width);
      auto before = random_bytes(random, width);
      auto mask = random_mask(random, width);
      if (extreme) {
        std::fill(now.begin(), now.end(), std::uint8_t{255});
        std::fill(before.begin(), before.end(), std::uint8_t{0});
        std::fill(mask.begin(), mask.end(), std::uint8_t{255});
      }
      IntensityChange expected;
      std::int64_t sum = 0;
      for (std::size_t x = 0; x < now.size(); ++x) {
        sum += now[x];
        if (mask[x] != 0) {
          ++expected.compared;
          expected.change += std::abs(now[x] - before[x]);
        }
      }
      for (const auto row : {intensity_change_row, intensity_change_row_ref}) {
        const IntensityChange actual = row(now.data(), before.data(), mask.data(), width);
        ASSERT_EQ(actual.compared, expected.compared);
        ASSERT_EQ(actual.change, expected.change);
      }
      ASSERT_EQ(intensity_sum_row(now.data(), width), sum);
      ASSERT_EQ(intensity_sum_row_ref(now.data(), width), sum);
    }
  }
}

}  // namespace vantage::kernels::flicker_sums_test
