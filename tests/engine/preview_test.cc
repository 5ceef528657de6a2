#include "engine/io/images/preview.h"

#include "tests/engine/engine_test.h"

namespace vantage::preview_test {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

DisparityMap row_of(std::initializer_list<float> values) {
  DisparityMap map(static_cast<int>(values.size()), 1);
  std::copy(values.begin(), values.end(), map.row(0));
  return map;
}

TEST(Preview, NearIsWarmFarIsColdUnknownIsBlack) {
  const auto preview = colour_preview(row_of({12, 48, kNan, kInfinity, 20}).view(), 10, 50);
  ASSERT_EQ(preview.width(), 5);
  ASSERT_EQ(preview.channels(), 3);
  EXPECT_GT(preview.at(0, 0, 2), preview.at(0, 0, 0) + 30);  // far: more blue than red
  EXPECT_GT(preview.at(1, 0, 0), preview.at(1, 0, 2) + 100);
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_EQ(preview.at(2, 0, channel), 0);
    EXPECT_EQ(preview.at(3, 0, channel), 0);
  }
}

/// Against the ends of the published table, and everywhere against the published polynomial fit of
/// it (A. Mikhailov, 2019), which is off by up to 32 levels at the dark end.
TEST(Preview, ColoursAreTurbo) {
  const auto ends = colour_preview(row_of({0, 1}).view(), 0, 1);
  const int published[2][3] = {{48, 18, 59}, {122, 4, 3}};
  const auto turbo = [](double x, int channel) {
    const double c[3][6] = {
        {0.13572138, 4.61539260, -42.66032258, 132.13108234, -152.94239396, 59.28637943},
        {0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604},
        {0.10667330, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973}};
    double value = 0;
    for (int i = 5; i >= 0; --i) {
      value = value * x + c[channel][i];
    }
    return 255 * std::clamp(value, 0.0, 1.0);
  };
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(ends.at(0, 0, channel), published[0][channel], 1);
    EXPECT_NEAR(ends.at(1, 0, channel), published[1][channel], 1);
    for (int i = 0; i <= 100; ++i) {
      const auto preview = colour_preview(row_of({static_cast<float>(i)}).view(), 0, 100);
      EXPECT_NEAR(preview.at(0, 0, channel), turbo(i / 100.0, channel), 33) << i << " " << channel;
    }
  }
}

TEST(Preview, ValuesOutsideTheRangeTakeItsEnds) {
  const auto preview = colour_preview(row_of({-1e30F, 0, 10, 1e30F}).view(), 0, 10);
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_EQ(preview.at(0, 0, channel), preview.at(1, 0, channel));
    EXPECT_EQ(preview.at(3, 0, channel), preview.at(2, 0, channel));
  }
}

TEST(Preview, RefusesRangesWithoutExtent) {
  const DisparityMap map = row_of({1});
  EXPECT_THROW(colour_preview(map.view(), 1, 1), UsageError);
  EXPECT_THROW(colour_preview(map.view(), 2, 1), UsageError);
  EXPECT_THROW(colour_preview(map.view(), kNan, 1), UsageError);
  EXPECT_THROW(colour_preview(map.view(), 0, kInfinity), UsageError);
}

TEST(Preview, RangeIgnoresAFewWildPixels) {
  DisparityMap map(101, 10);
  for (const auto [x, y] : positions_of(101, 10)) {
    map.at(x, y) = static_cast<float>(x);
  }
  map.at(50, 3) = 1e9F;
  map.at(51, 3) = -1e9F;
  map.at(52, 3) = kNan;
  const PreviewRange range = choose_preview_range(map.view());
  EXPECT_NEAR(range.min_px, 1, 1.01);
  EXPECT_NEAR(range.max_px, 99, 1.01);
}

TEST(Preview, RangeOfFlatAndUnknownMapsIsUsable) {
  const PreviewRange flat = choose_preview_range(row_of({7}).view());
  EXPECT_EQ(flat.min_px, 6.5F);
  EXPECT_EQ(flat.max_px, 7.5F);
  const PreviewRange unknown = choose_preview_range(row_of({kNan, kInfinity}).view());
  EXPECT_LT(unknown.min_px, unknown.max_px);
}

}  // namespace vantage::preview_test
