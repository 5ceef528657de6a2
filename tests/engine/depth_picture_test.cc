#include "engine/sequence/shots/depth_picture.h"

#include "tests/engine/engine_test.h"

namespace vantage::depth_picture_test {

/// Two shots, the second with a range of its own.
ShotTable two_shots() {
  ShotTable table;
  table.shots.resize(2);
  table.shots[0].end_frame = 5;
  table.shots[1].first_frame = 5;
  table.shots[1].end_frame = 9;
  table.shots[1].search = DisparityRange{-40, 7};
  return table;
}

DepthVideoScale scale_of(DepthVideoScale::Scope scope) {
  DepthVideoScale scale;
  scale.scope = scope;
  return scale;
}

TEST(DepthPicture, LevelsSpanTheRangeAndZeroIsUnknown) {
  DisparityMap map(6, 1);
  const float values[] = {-2, 10, 4, -50, 50, std::numeric_limits<float>::quiet_NaN()};
  const int levels[] = {1, 65535, 32768, 1, 65535, 0};
  for (int x = 0; x < 6; ++x) {
    map.at(x, 0) = values[x];
  }
  Image<std::uint16_t> picture(2, 2, 3);  // of another shape
  paint_depth(map.view(), {-2, 10}, picture);
  ASSERT_EQ(picture.width(), 6);
  ASSERT_EQ(picture.channels(), 1);
  for (int x = 0; x < 6; ++x) {
    EXPECT_EQ(picture.at(x, 0), levels[x]) << x;
  }
}

TEST(DepthPicture, RangesAreOfTheFilmTheShotOrGiven) {
  using Scope = DepthVideoScale::Scope;
  const ShotTable shots = two_shots();
  const DisparityRange film{0, 63};
  const auto range = [&](DepthVideoScale scale, const ShotTable* table, int frame) {
    const PreviewRange found = depth_range_of(scale, film, table, frame);
    return std::pair(found.min_px, found.max_px);
  };
  EXPECT_EQ(range(scale_of(Scope::kFilm), nullptr, 6), std::pair(0.0F, 63.0F));
  EXPECT_EQ(range(scale_of(Scope::kFilm), &shots, 0), std::pair(-40.0F, 63.0F));
  EXPECT_EQ(range(scale_of(Scope::kShot), &shots, 4), std::pair(0.0F, 63.0F));
  EXPECT_EQ(range(scale_of(Scope::kShot), &shots, 5), std::pair(-40.0F, 7.0F));
  EXPECT_EQ(range({.scope = Scope::kGiven, .given = {-1, 2}}, &shots, 5), std::pair(-1.0F, 2.0F));
  // One disparity still has a span.
  const PreviewRange one = depth_range_of(scale_of(Scope::kFilm), {5, 5}, nullptr, 0);
  EXPECT_EQ(one.max_px - one.min_px, 1);
}

}  // namespace vantage::depth_picture_test
