#include "engine/examination/image_statistics.h"

#include "engine/image/intensity_rows.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/random_grey.h"

namespace vantage::image_statistics_test {

/// The definition, pixel by pixel, of those with a pixel to their right.
double plain_textureless_share(const Image<std::uint8_t>& image, double threshold) {
  const auto squared = [&](int x, int y) {
    const int column = std::clamp(x, 0, image.width() - 2);
    const int row = std::clamp(y, 0, image.height() - 1);
    const double gradient = image.at(column + 1, row) - image.at(column, row);
    return gradient * gradient;
  };
  int count = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x + 1 < image.width(); ++x) {
      double sum = 0;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          sum += squared(x + dx, y + dy);
        }
      }
      count += sum < 9 * threshold ? 1 : 0;
    }
  }
  return static_cast<double>(count) / ((image.width() - 1) * image.height());
}

TEST(ImageStatistics, CountWhatHasNoTexture) {
  for (const auto& [width, height] : {std::pair{71, 67}, {2, 5}, {5, 1}}) {
    Image<std::uint8_t> image(width, height);
    unsigned value = 7;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        value = value * 1664525U + 1013904223U;
        // Steps of 0 to 3 above, of 0 to 7 below.
        image.at(x, y) = static_cast<std::uint8_t>(100 + (value >> 20U) % (y < 30 ? 4 : 8));
      }
    }
    const double plain = plain_textureless_share(image, 4);
    const double with_noise = plain_textureless_share(image, 4 + 2 * 2.5 * 2.5);
    const Photograph photograph{std::move(image)};
    EXPECT_EQ(image_statistics(photograph, 0).textureless_share, plain);
    EXPECT_EQ(image_statistics(photograph, 2.5).textureless_share, with_noise);
    if (width == 71) {
      EXPECT_GT(plain, 0.2);
      EXPECT_GT(with_noise, plain);
      EXPECT_LT(with_noise, 1);
    }
  }
}

TEST(ImageStatistics, CountBlackAndWhitePixels) {
  Image<std::uint8_t> image(5, 2);
  image.fill(100);
  image.at(0, 0) = 0;
  image.at(4, 1) = 255;
  image.at(3, 1) = 254;
  const ImageStatistics statistics = image_statistics({std::move(image)}, 0);
  EXPECT_EQ(statistics.black_share, 0.1);
  EXPECT_EQ(statistics.white_share, 0.2);
  EXPECT_NEAR(statistics.mean_grey, (700 + 255 + 254) / 10.0, 1e-6);
  EXPECT_EQ(image_statistics({Image<std::uint8_t>(1, 3)}, 0).textureless_share, 1);
}

}  // namespace vantage::image_statistics_test
