#include "engine/matching/aggregation/smoothing_kernels.h"

#include "tests/engine/engine_test.h"

namespace vantage::smoothing_kernels_test {

double gain(const std::vector<float>& kernel) {
  double sum = kernel[0];
  for (std::size_t k = 1; k < kernel.size(); ++k) {
    sum += 2.0 * kernel[k];
  }
  return sum;
}

double variance(const std::vector<float>& kernel) {
  double sum = 0;
  for (std::size_t k = 1; k < kernel.size(); ++k) {
    sum += 2.0 * static_cast<double>(k * k) * kernel[k];
  }
  return sum;
}

TEST(SmoothingKernels, GaussianReachesFourSigma) {
  EXPECT_EQ(gaussian_kernel(2).size(), 9U);
  EXPECT_EQ(gaussian_kernel(0.5).size(), 3U);
  EXPECT_EQ(gaussian_kernel(2.1).size(), 10U);
  for (const double sigma_px : {0.5, 1.0, 2.0, 7.3, 16.0}) {
    const std::vector<float> kernel = gaussian_kernel(sigma_px);
    EXPECT_NEAR(gain(kernel), 1, 1e-6);
    EXPECT_NEAR(kernel[1] / kernel[0], std::exp(-0.5 / (sigma_px * sigma_px)), 1e-6);
  }
  // Cut off at four standard deviations, where next to nothing is left.
  EXPECT_NEAR(variance(gaussian_kernel(2)), 4, 0.01);
}

TEST(SmoothingKernels, CascadeOfTheBookIsExact) {
  EXPECT_THAT(box_cascade_widths_px(2), ElementsAre(3, 3, 3, 5));
  const std::vector<float> kernel = box_cascade_kernel({3, 3, 3, 5});
  ASSERT_EQ(kernel.size(), 6U);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(kernel[k] * 135, (std::array{25, 23, 17, 10, 4, 1})[k], 1e-5);
  }
  EXPECT_NEAR(variance(kernel), 4, 1e-6);
}

TEST(SmoothingKernels, CascadeIsAsNearAsOddWidthsAllow) {
  for (double sigma_px = 0.5; sigma_px <= 6; sigma_px += 0.07) {
    const std::array<int, 4> widths = box_cascade_widths_px(sigma_px);
    const auto distance = [&](const std::array<int, 4>& some) {
      double sum = 0;
      for (const int width : some) {
        sum += (width * width - 1) / 12.0;
      }
      return std::abs(sum - sigma_px * sigma_px);
    };
    double min = std::numeric_limits<double>::max();
    for (int a = 1; a <= 25; a += 2) {
      for (int b = 1; b <= 25; b += 2) {
        for (int c = 1; c <= 25; c += 2) {
          for (int d = 1; d <= 25; d += 2) {
            min = std::min(min, distance({a, b, c, d}));
          }
        }
      }
    }
    EXPECT_NEAR(distance(widths), min, 1e-12) << "sigma " << sigma_px;
    const std::vector<float> kernel = box_cascade_kernel(widths);
    EXPECT_NEAR(gain(kernel), 1, 1e-6) << "sigma " << sigma_px;
    EXPECT_NEAR(variance(kernel), sigma_px * sigma_px, min + 1e-5) << "sigma " << sigma_px;
  }
}

}  // namespace vantage::smoothing_kernels_test
