#include "engine/evaluation/disparity_section.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/error.h"
#include "tests/engine/oracle_comparison.h"

namespace vantage {
namespace disparity_section_test {

constexpr DisparityRange kRange{0, 9};

TEST(DisparitySection, OfTheMembraneEqualsThePlainTranscription) {
  const test::PhotographPair pair = test::textured_pair(47, 21, kRange, test::PixelKind::kGrey8, 3);
  Execution execution({.threads = 2, .strip_width_px = 13});
  for (const int iterations : {0, 1, 10}) {
    MatchOptions options;
    options.method = MatchMethod::kMembrane;
    options.disparities = kRange;
    options.parameters.iterations = iterations;
    const StereoMatcher matcher(options, execution);
    const DisparitySection section =
        disparity_section(matcher, pair.left, pair.right, Side::kRight, VolumeKind::kAggregated, 8);
    const test::Volume expected =
        test::plain_aggregate(pair.right, pair.left, Side::kRight, kRange, options.resolved());
    ASSERT_EQ(section.values.width(), 47);
    ASSERT_EQ(section.values.height(), 10);
    for (int x = 0; x < 47; ++x) {
      for (int i = 0; i < 10; ++i) {
        const float value = section.values.at(x, i);
        if (expected.has_partner(x, i)) {
          EXPECT_NEAR(value, expected.at(x, 8, i), 1e-3 * std::max(1.0, expected.at(x, 8, i)));
        } else {
          EXPECT_TRUE(std::isnan(value));
        }
      }
    }
    EXPECT_THROW(
        disparity_section(matcher, pair.left, pair.right, Side::kLeft, VolumeKind::kCosts, 21),
        UsageError);
  }
}

TEST(DisparitySection, PictureIsDarkWhereLikelyAndUpward) {
  DisparitySection section;
  section.values = Image<float>(2, 2);
  section.values.at(0, 0) = 0;
  section.values.at(1, 0) = 5;
  section.values.at(0, 1) = 20;
  section.values.at(1, 1) = std::nanf("");
  const Image<std::uint8_t> picture = section_picture(section, 0, 10);
  EXPECT_EQ(picture.at(0, 1), 0);
  EXPECT_EQ(picture.at(1, 1), 128);
  EXPECT_EQ(picture.at(0, 0), 255);
  EXPECT_EQ(picture.at(1, 0), 255);
  EXPECT_FLOAT_EQ(section_quantile(section, 0.5), 5);
  EXPECT_FLOAT_EQ(section_quantile(section, 1), 20);
}

}  // namespace disparity_section_test
}  // namespace vantage
