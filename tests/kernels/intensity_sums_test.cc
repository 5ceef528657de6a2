#include "kernels/intensity_sums/intensity_sums.h"

#include "tests/kernels/synthesis_rows.h"

namespace vantage::kernels::intensity_sums_test {

TEST(IntensitySums, CountOnlyWhatBothShow) {
  std::mt19937 random(10);
  for (const int channels : {1, 3}) {
    for (const int width : kAwkwardWidths) {
      const RandomPair pair(random, width, channels, 255);
      const IntensitySums sums = intensity_sums_row(pair.row);
      const int lanes = pixel_lanes(channels);
      std::int64_t pixels = 0;
      for (int c = 0; c < channels; ++c) {
        double left = 0, right = 0, left_right = 0, left_left = 0;
        pixels = 0;
        for (int x = 0; x < width; ++x) {
          const auto i = static_cast<std::size_t>(x);
          const auto k = static_cast<std::size_t>(x * lanes + c);
          if (!std::isnan(pair.left_d[i]) && !std::isnan(pair.right_d[i]) &&
              std::abs(pair.left_d[i] - pair.right_d[i]) <= 1) {
            ++pixels;
            left += pair.left_colours[k];
            right += pair.right_colours[k];
            left_right += double{pair.left_colours[k]} * pair.right_colours[k];
            left_left += double{pair.left_colours[k]} * pair.left_colours[k];
          }
        }
        EXPECT_DOUBLE_EQ(sums.left[c], left);
        EXPECT_DOUBLE_EQ(sums.right[c], right);
        EXPECT_DOUBLE_EQ(sums.left_right[c], left_right);
        EXPECT_DOUBLE_EQ(sums.left_left[c], left_left);
      }
      EXPECT_EQ(sums.pixels, pixels);
    }
  }
}

TEST(IntensitySums, EqualOnEveryInstructionSetAndToReference) {
  std::mt19937 random(11);
  for (const int channels : {1, 3, 4}) {
    for (const int width : {1, 63, 64, 65, 1500}) {
      RandomPair pair(random, width, channels, 1);
      if (width >= 64) {
        std::fill_n(pair.left_d.begin(), 64, 5.0F);  // whole words of pixels that count
        std::fill_n(pair.right_d.begin(), 64, 5.5F);
      }
      const IntensitySums expected = intensity_sums_row_ref(pair.row);
      for_each_target([&] {
        const IntensitySums sums = intensity_sums_row(pair.row);
        ASSERT_EQ(sums.pixels, expected.pixels);
        for (int c = 0; c < channels; ++c) {
          ASSERT_EQ(sums.left[c], expected.left[c]);
          ASSERT_EQ(sums.right[c], expected.right[c]);
          ASSERT_EQ(sums.left_right[c], expected.left_right[c]);
          ASSERT_EQ(sums.left_left[c], expected.left_left[c]);
        }
      });
    }
  }
}

}  // namespace vantage::kernels::intensity_sums_test
