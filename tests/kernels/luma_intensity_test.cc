#include "kernels/luma_intensity/luma_intensity.h"

#include <iterator>

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::luma_intensity_test {

VANTAGE_ON_EVERY_TARGET(LumaIntensity);

TEST_P(LumaIntensity, AreTheRoundedLuma) {
  std::mt19937 random(72);
  for (const int channels : {1, 3, 4}) {
    for (const int width : {1, 2, 15, 16, 17, 31, 64, 65, 301}) {
      UnalignedRow<std::uint8_t> pixels(width * channels, random() % 5);
      for (std::size_t k = 0; k < pixels.size(); ++k) {
        pixels[k] = random() % 4 == 0 ? 255 : static_cast<std::uint8_t>(random());
      }
      const auto reference =
          equal_rows<std::uint8_t>(static_cast<std::size_t>(width), luma_intensity_row,
                                   luma_intensity_row_ref, pixels.data(), width, channels);
      for (int x = 0; x < width; ++x) {
        const std::uint8_t* pixel = pixels.data() + static_cast<std::ptrdiff_t>(x) * channels;
        const double luma =
            channels == 1 ? pixel[0] : 0.299 * pixel[0] + 0.587 * pixel[1] + 0.114 * pixel[2];
        ASSERT_NEAR(reference[x], luma, channels == 1 ? 0 : 1);
      }
    }
  }
}

TEST_P(LumaIntensity, LumaIsNotRounded) {
  std::mt19937 random(73);
  for (const int channels : {3, 4}) {
    for (const int width : {1, 2, 15, 16, 17, 31, 64, 65, 301}) {
      UnalignedRow<std::uint8_t> pixels(width * channels, random() % 5);
      for (std::size_t k = 0; k < pixels.size(); ++k) {
        pixels[k] = random() % 4 == 0 ? 255 : static_cast<std::uint8_t>(random());
      }
      const auto reference = equal_rows<float>(static_cast<std::size_t>(width), luma_row,
                                               luma_row_ref, pixels.data(), width, channels);
      for (int x = 0; x < width; ++x) {
        const std::uint8_t* pixel = pixels.data() + static_cast<std::ptrdiff_t>(x) * channels;
        ASSERT_NEAR(reference[x], 0.299 * pixel[0] + 0.587 * pixel[1] + 0.114 * pixel[2], 1e-4);
      }
    }
  }
}

TEST_P(LumaIntensity, BlackAndWhiteStayThemselves) {
  const std::uint8_t black[4 * 64] = {};
  std::uint8_t pixels[4 * 64];
  std::fill(std::begin(pixels), std::end(pixels), std::uint8_t{255});
  std::uint8_t levels[64];
  luma_intensity_row(pixels, 64, 4, levels);
  EXPECT_EQ(std::count(std::begin(levels), std::end(levels), 255), 64);
  luma_intensity_row(black, 64, 4, levels);
  EXPECT_EQ(std::count(std::begin(levels), std::end(levels), 0), 64);
}

}  // namespace vantage::kernels::luma_intensity_test
