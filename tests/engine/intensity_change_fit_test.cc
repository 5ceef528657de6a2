#include "engine/matching/estimation/intensity_change_fit.h"

#include "tests/engine/engine_test.h"

namespace vantage::intensity_change_fit_test {

struct Line {
  double gain;
  double offset;
};

/// Levels of a line with Gaussian noise of equal share in both images; some pairs are wrong.
std::vector<IntensityPair> pairs_of(const Line& line, double noise, double wrong_share, int count) {
  std::mt19937 random(5);
  std::normal_distribution<double> gaussian(0, 1);
  std::uniform_real_distribution<double> level(20, 150);
  std::vector<IntensityPair> pairs;
  for (int k = 0; k < count; ++k) {
    const double other = level(random);
    const bool is_wrong = level(random) < 20 + 130 * wrong_share;
    const double reference = is_wrong ? level(random) : line.gain * other + line.offset;
    pairs.push_back({static_cast<float>(reference + line.gain * noise * gaussian(random)),
                     static_cast<float>(other + noise * gaussian(random))});
  }
  return pairs;
}

TEST(IntensityChangeFit, RecoversLinesDespiteNoiseAndWrongMatches) {
  for (const Line line : {Line{1, 0}, Line{1.4, -12}, Line{.6, 30}, Line{2.5, 4}}) {
    for (const double noise : {0., 4.}) {
      for (const double wrong_share : {0., .2}) {
        const auto fit = fit_intensity_change(pairs_of(line, noise, wrong_share, 20000));
        ASSERT_TRUE(fit.has_value());
        EXPECT_NEAR(fit->gain, line.gain, 0.01 * line.gain) << noise << ", " << wrong_share;
        // At the middle of the levels.
        EXPECT_NEAR(fit->gain * 85 + fit->offset, line.gain * 85 + line.offset, 0.5);
      }
    }
  }
}

TEST(IntensityChangeFit, SaysWhenPairsDoNotTell) {
  EXPECT_FALSE(fit_intensity_change({}));
  EXPECT_FALSE(
      fit_intensity_change(pairs_of({1, 0}, 1, 0, static_cast<int>(kMinIntensityPairs) - 1)));
  EXPECT_TRUE(fit_intensity_change(pairs_of({1, 0}, 1, 0, static_cast<int>(kMinIntensityPairs))));
  EXPECT_FALSE(fit_intensity_change(pairs_of({1, 0}, 1, 1, 5000))) << "unrelated levels";
  EXPECT_FALSE(fit_intensity_change(pairs_of({6, 0}, 1, 0, 5000)))
      << "a gain that no two cameras have";
  EXPECT_FALSE(fit_intensity_change(std::vector<IntensityPair>(5000, {100, 90}))) << "no contrast";
}

TEST(IntensityChangeFit, NoiseIsSeenWhereMostResidualsAreZero) {
  std::mt19937 random(7);
  std::normal_distribution<double> gaussian(0, 5);
  std::vector<float> residuals;
  for (int k = 0; k < 20000; ++k) {
    residuals.push_back(static_cast<float>(std::max(0.0, std::abs(gaussian(random)) - 4)));
  }
  EXPECT_NEAR(robust_sigma(residuals), 0, 0.1);
  EXPECT_NEAR(noise_sigma(residuals), (5 * 1.6449 - 4) / 1.6449, 0.2);
}

TEST(RobustSigma, IsThatOfTheGaussianWhateverTheOutliers) {
  std::mt19937 random(6);
  std::normal_distribution<double> gaussian(0, 7);
  std::vector<float> residuals;
  for (int k = 0; k < 20001; ++k) {
    residuals.push_back(static_cast<float>(k % 20 == 0 ? 1000 : std::abs(gaussian(random))));
  }
  EXPECT_NEAR(robust_sigma(residuals), 7, 0.6);
  EXPECT_NEAR(noise_sigma(residuals), 7, 1.2);
  std::vector<float> one = {3};
  EXPECT_FLOAT_EQ(static_cast<float>(robust_sigma(one)), 3 * 1.4826F);
}

}  // namespace vantage::intensity_change_fit_test
