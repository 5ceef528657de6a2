#include "engine/image/no_data.h"

#include "tests/engine/engine_test.h"

namespace vantage::no_data_test {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

Image<float> raster_of(const std::vector<std::vector<float>>& rows) {
  Image<float> raster(static_cast<int>(rows.front().size()), static_cast<int>(rows.size()));
  for (const auto [x, y] : positions_of(raster)) {
    raster.at(x, y) = rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
  }
  return raster;
}

TEST(NoData, OneFiniteValueIsData) {
  EXPECT_FALSE(has_data(raster_of({{kNone, INFINITY}, {-INFINITY, kNone}}).view()));
  EXPECT_TRUE(has_data(raster_of({{kNone, kNone}, {kNone, -3}}).view()));
}

TEST(NoData, GapsAreFilledAlongRowsThenFromTheNearestRow) {
  // The smallest value becomes 0, the largest 65535.
  const Photograph filled = photograph_without_gaps(raster_of({{kNone, kNone, kNone, kNone, kNone},
                                                               {kNone, 10, kNone, kNone, 30},
                                                               {kNone, kNone, kNone, kNone, kNone},
                                                               {20, INFINITY, kNone, 30, kNone}})
                                                        .view(),
                                                    execution());
  const auto& image = std::get<Image<std::uint16_t>>(filled.pixels);
  const int levels[4][5] = {{0, 0, 0, 65535, 65535},
                            {0, 0, 0, 65535, 65535},
                            {0, 0, 0, 65535, 65535},  // as far from both rows: the upper one
                            {32768, 32768, 65535, 65535, 65535}};
  for (const auto [x, y] : positions_of(5, 4)) {
    EXPECT_EQ(image.at(x, y), levels[y][x]) << x << " " << y;
  }
}

TEST(NoData, ExtremesAreClippedAndOneValueIsGrey) {
  Image<float> raster(100, 10);
  for (const auto [x, y] : positions_of(100, 10)) {
    raster.at(x, y) = static_cast<float>(x);
  }
  raster.at(50, 5) = 1e9F;
  raster.at(51, 5) = -1e9F;
  const Photograph clipped = photograph_without_gaps(raster.view(), execution());
  const auto& image = std::get<Image<std::uint16_t>>(clipped.pixels);
  EXPECT_EQ(image.at(50, 5), 65535);
  EXPECT_EQ(image.at(51, 5), 0);
  EXPECT_NEAR(image.at(50, 4), 65535 * 50 / 99.0, 1);

  const Photograph flat = photograph_without_gaps(raster_of({{7, kNone, 7}}).view(), execution());
  EXPECT_EQ(std::get<Image<std::uint16_t>>(flat.pixels).at(1, 0), 32768);
}

TEST(NoData, DisparitiesNeedDataAtBothEndsAndAMatch) {
  const Image<float> left = raster_of({{1, 1, kNone, 1, 1, 1}});
  const Image<float> right = raster_of({{1, kNone, 1, 1, 1, 1}});
  MatchedMap map;
  map.disparity_px = raster_of({{1, 0.4F, 1, 2, 1, 1.4F}});
  map.unmatched.resize(6, 1);
  for (int x = 0; x < 6; ++x) {
    map.unmatched.at(x, 0) = x == 4 ? 255 : 0;
  }
  DisparityMap result;
  disparities_of_data(map, left.view(), right.view(), execution(), result);
  // Outside; no data at 0.6 ≈ 1; none in the left raster; none at 1; unmatched; at 3.6 ≈ 4.
  for (int x = 0; x < 5; ++x) {
    EXPECT_TRUE(std::isnan(result.at(x, 0))) << x;
  }
  EXPECT_EQ(result.at(5, 0), 1.4F);
  EXPECT_THROW(
      disparities_of_data(map, left.view(), raster_of({{1, 1}}).view(), execution(), result),
      Error);
}

}  // namespace vantage::no_data_test
