#include "kernels/still_pixels/still_pixels.h"

#include <cstdlib>

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::still_pixels_test {

constexpr int kWidths[] = {1, 2, 3, 15, 16, 17, 31, 63, 64, 65, 129, 200};

std::vector<std::uint8_t> random_levels(std::mt19937& random, int width, int readable) {
  std::vector<std::uint8_t> levels(readable, 0xEE);
  for (int x = 0; x < width; ++x) {
    levels[x] = random() % 5 == 0 ? static_cast<std::uint8_t>(random() % 2 * 255)
                                  : static_cast<std::uint8_t>(random());
  }
  return levels;
}

VANTAGE_ON_EVERY_TARGET(StillPixelsKernel);

TEST_P(StillPixelsKernel, ChangesAreSumsOverThreeByThreePixels) {
  std::mt19937 random(73);
  for (const int width : kWidths) {
    const int readable = still_row_values(width) - 2 * kStillMargin;
    std::vector<std::uint8_t> now[3];
    std::vector<std::uint8_t> before[3];
    FrameRows rows;
    rows.width = width;
    for (std::size_t k = 0; k < 3; ++k) {
      now[k] = random_levels(random, width, readable);
      before[k] = random() % 3 == 0 ? now[k] : random_levels(random, width, readable);
      rows.now[k] = now[k].data();
      rows.before[k] = before[k].data();
    }
    const auto values = static_cast<std::size_t>(still_row_values(width));
    std::vector<std::int16_t> work(values);
    std::vector<std::int16_t> change(values);
    box_change_row(rows, work.data() + kStillMargin, change.data() + kStillMargin);
    for (int x = -1; x <= width; ++x) {
      const int centre = std::clamp(x, 0, width - 1);
      int sum = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        for (int dx = -1; dx <= 1; ++dx) {
          const auto column = static_cast<std::size_t>(std::clamp(centre + dx, 0, width - 1));
          sum += now[k][column] - before[k][column];
        }
      }
      const auto place = static_cast<std::size_t>(x + kStillMargin);
      ASSERT_EQ(change[place], std::abs(sum)) << "column " << x << " of " << width;
    }
  }
}

TEST_P(StillPixelsKernel, StillMeansNoLargerChangeAround) {
  std::mt19937 random(74);
  for (const int width : kWidths) {
    const auto values = static_cast<std::size_t>(still_row_values(width));
    std::vector<std::int16_t> rows[3];
    const std::int16_t* changes[3];
    for (std::size_t k = 0; k < 3; ++k) {
      rows[k].assign(values, 0x7000);
      for (int x = 0; x < width; ++x) {
        rows[k][x + kStillMargin] =
            static_cast<std::int16_t>(random() % 20 == 0 ? 27 + random() % 3 : random() % 27);
      }
      rows[k][kStillMargin - 1] = rows[k][kStillMargin];
      rows[k][kStillMargin + width] = rows[k][kStillMargin + width - 1];
      changes[k] = rows[k].data() + kStillMargin;
    }
    std::vector<std::uint8_t> still(values);
    still_row(changes, width, 27, still.data());
    for (int x = 0; x < width; ++x) {
      int max = 0;
      for (const std::int16_t* row : changes) {
        max = std::max({max, int{row[x - 1]}, int{row[x]}, int{row[x + 1]}});
      }
      ASSERT_EQ(still[x], max <= 27 ? 255 : 0) << x << " of " << width;
    }
  }
}

}  // namespace vantage::kernels::still_pixels_test
