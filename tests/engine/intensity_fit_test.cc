#include "engine/synthesis/intensity_fit.h"

#include "tests/engine/engine_test.h"

namespace vantage::intensity_fit_test {

kernels::IntensitySums sums_of(const std::vector<double>& left, const std::vector<double>& right) {
  kernels::IntensitySums sums;
  for (std::size_t i = 0; i < left.size(); ++i) {
    ++sums.pixels;
    sums.left[0] += left[i];
    sums.right[0] += right[i];
    sums.left_right[0] += left[i] * right[i];
    sums.left_left[0] += left[i] * left[i];
  }
  return sums;
}

void expect_identity(const IntensityFit& fit) {
  EXPECT_EQ(fit.offset, 0);
  EXPECT_EQ(fit.gain, 1);
}

TEST(IntensityFit, FindsALineInGreyLevels) {
  const IntensityFit fit = fit_intensities(sums_of({0.1, 0.5, 0.9}, {0.3, 0.5, 0.7}), 0, 255);
  EXPECT_NEAR(fit.gain, 0.5, 1e-12);
  EXPECT_NEAR(fit.offset, 0.25 * 255, 1e-9);
}

TEST(IntensityFit, IdentityWhereDegenerate) {
  expect_identity(fit_intensities(sums_of({}, {}), 0, 1));
  expect_identity(fit_intensities(sums_of({10}, {20}), 0, 1));
  expect_identity(fit_intensities(sums_of({10, 10, 10}, {20, 21, 22}), 0, 1));   // no contrast
  expect_identity(fit_intensities(sums_of({10, 20, 30}, {30, 20, 10}), 0, 1));   // b < 0
  expect_identity(fit_intensities(sums_of({10, 20, 30}, {20, 20, 20}), 0, 1));   // b = 0
  expect_identity(fit_intensities(sums_of({10, 20, 30}, {0, 200, 400}), 0, 1));  // b = 20
  // A constant image whose sums do not cancel exactly.
  const std::vector<double> constant(100000, 0.1);
  expect_identity(fit_intensities(sums_of(constant, constant), 0, 255));
}

TEST(FitChannels, AlphaHasTheIdentity) {
  kernels::IntensitySums sums = sums_of({10, 20, 40}, {15, 20, 30});
  for (int c = 1; c < 4; ++c) {
    sums.left[c] = sums.left[0];
    sums.right[c] = c * sums.right[0];
    sums.left_left[c] = sums.left_left[0];
    sums.left_right[c] = c * sums.left_right[0];
  }
  for (const int channels : {1, 3, 4}) {
    const auto fits = fit_channels(sums, channels, 2);
    for (int c = 0; c < 4; ++c) {
      if (c < std::min(channels, 3)) {
        EXPECT_EQ(fits[static_cast<std::size_t>(c)], fit_intensities(sums, c, 2));
        EXPECT_NEAR(fits[static_cast<std::size_t>(c)].gain, 0.5 * std::max(1, c), 1e-12);
      } else {
        expect_identity(fits[static_cast<std::size_t>(c)]);
      }
    }
  }
}

}  // namespace vantage::intensity_fit_test
