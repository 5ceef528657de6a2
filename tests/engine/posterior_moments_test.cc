// Mean and variance of p(d) against those of the plain transcription's probabilities.
#include "engine/matching/volume/posterior_moments.h"

#include "engine/matching/stereo_matcher.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/method_cases.h"
#include "tests/engine/oracle_comparison.h"

namespace vantage::posterior_moments_test {

constexpr DisparityRange kRange{-3, 17};
constexpr int kWidth = 43;
constexpr int kHeight = 21;
/// One of each kind of cells.
const std::set<std::string> kMethods = {"bayes", "bayes_maximum", "bayes_levels",
                                        "bayes_maximum_levels"};

TEST(PosteriorMoments, OfNumbers) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  PosteriorMoments moments;
  moments.start({.width_px = 3,
                 .height_px = 1,
                 .disparities = {5, 8},
                 .content = VolumeContent::kProbabilities});
  const std::vector<float> values = {kNone, 0.25F, 0.25F, 0,     0.1F,  0,
                                     0,     0.3F,  kNone, kNone, kNone, kNone};
  moments.write(0, 0, 3, values.data());
  EXPECT_FLOAT_EQ(moments.mean_px().at(0, 0), 6.5F);
  EXPECT_FLOAT_EQ(moments.variance_px2().at(0, 0), 0.25F);
  EXPECT_FLOAT_EQ(moments.mean_px().at(1, 0), 7.25F);
  EXPECT_FLOAT_EQ(moments.variance_px2().at(1, 0), 0.25F * 2.25F * 2.25F + 0.75F * 0.75F * 0.75F);
  EXPECT_TRUE(std::isnan(moments.mean_px().at(2, 0)));
  EXPECT_TRUE(std::isnan(moments.variance_px2().at(2, 0)));
  moments.start({.width_px = 1,
                 .height_px = 1,
                 .disparities = {2, 3},
                 .steps_per_px = 2,
                 .content = VolumeContent::kProbabilities});
  const std::vector<float> halves = {0, 0.5F, 0.5F};
  moments.write(0, 0, 1, halves.data());
  EXPECT_FLOAT_EQ(moments.mean_px().at(0, 0), 2.75F);
  EXPECT_FLOAT_EQ(moments.variance_px2().at(0, 0), 0.0625F);
  EXPECT_THROW(moments.start({.width_px = 3, .height_px = 1}), UsageError);
  EXPECT_THROW(moments.start({.width_px = 3,
                              .height_px = 1,
                              .disparities_y = DisparityRange{0, 1},
                              .content = VolumeContent::kProbabilities}),
               UsageError);
}

TEST(PosteriorMoments, EqualThePlainTranscription) {
  const PhotographPair pair = textured_pair(kWidth, kHeight, kRange, PixelKind::kGrey8, 5);
  Execution execution({.threads = 2, .strip_width_px = 19});
  int methods = 0;
  for (const MethodCase& method : method_cases(kRange)) {
    const MethodParameters parameters = method.options.resolved();
    if (!kMethods.contains(method.name)) {
      continue;
    }
    SCOPED_TRACE(method.name);
    ++methods;
    PosteriorMoments moments;
    DisparityMaps maps;
    const VolumeRequest request{.side = Side::kRight, .sink = &moments};
    StereoMatcher(method.options, execution)
        .match(pair.left, pair.right, {.volumes = {&request, 1}}, maps);
    const Volume energies =
        plain_aggregate(pair.right, pair.left, Side::kRight, kRange, parameters);
    // Rounding of the cells: is_stepped().
    const double tolerance = is_stepped(method) ? 0.05 : 6e-3;
    int wrong = 0;
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      double total = 0;
      double first = 0;
      double second = 0;
      for (int i = 0; i < kRange.count(); ++i) {
        const double d = kRange.min + i;
        const double p = energies.has_partner(x, i) ? std::exp(-energies.at(x, y, i)) : 0;
        total += p;
        first += p * d;
        second += p * d * d;
      }
      const double mean = first / total;
      const double variance = second / total - mean * mean;
      wrong += std::abs(moments.mean_px().at(x, y) - mean) <= tolerance &&
                       std::abs(moments.variance_px2().at(x, y) - variance) <=
                           10 * tolerance * std::max(1.0, variance)
                   ? 0
                   : 1;
    }
    EXPECT_LE(wrong, is_stepped(method) ? kWidth * kHeight / 50 : 0);
  }
  EXPECT_EQ(methods, static_cast<int>(kMethods.size()));
}

}  // namespace vantage::posterior_moments_test
