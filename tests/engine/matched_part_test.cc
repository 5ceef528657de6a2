#include "engine/matching/region/matched_part.h"

#include "engine/matching/stereo_matcher.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/random_grey.h"

namespace vantage::matched_part_test {

/// Of one window per pixel, which a region with its context has whole.
MatchOptions window_options(DisparityRange disparities) {
  MatchOptions options;
  options.method = MatchMethod::kSsd;
  options.disparities = disparities;
  options.raw = true;
  return options;
}

bool is_inside(const ImageRegion& region, int x, int y) {
  return x >= region.x_px && x < region.x_px + region.width_px && y >= region.y_px &&
         y < region.y_px + region.height_px;
}

void expect_same_inside(const MatchedMap& part, const MatchedMap& whole,
                        const ImageRegion& region) {
  ASSERT_EQ(part.disparity_px.width(), whole.disparity_px.width());
  for (const auto [x, y] : positions_of(whole.disparity_px.width(), whole.disparity_px.height())) {
    if (is_inside(region, x, y)) {
      EXPECT_EQ(part.disparity_px.at(x, y), whole.disparity_px.at(x, y)) << x << ", " << y;
      EXPECT_EQ(part.unmatched.at(x, y), whole.unmatched.at(x, y)) << x << ", " << y;
    } else {
      EXPECT_TRUE(std::isnan(part.disparity_px.at(x, y))) << x << ", " << y;
      EXPECT_EQ(part.unmatched.at(x, y), 255) << x << ", " << y;
    }
  }
}

TEST(Region, MapsInsideAreThoseOfWholeImages) {
  const Photograph left = random_grey(173, 91, 200, 1);
  const Photograph right = random_grey(173, 91, 200, 2);
  const ImageRegion region{90, 41, 31, 9};
  for (const DisparityRange range : {DisparityRange{2, 19}, DisparityRange{-21, -3}}) {
    MatchOptions options = window_options(range);
    DisparityMaps whole;
    StereoMatcher(options).match(left, right, {}, whole);
    options.roi = region;
    DisparityMaps part;
    StereoMatcher(options).match(left, right, {}, part);
    expect_same_inside(part.left, whole.left, region);
    // Whatever a pixel of the region may be compared with.
    const int first = region.x_px - range.max;
    const int end = region.x_px + region.width_px - range.min;
    expect_same_inside(part.right, whole.right,
                       {first, region.y_px, end - first, region.height_px});
  }
}

TEST(Region, OfSeveralImagesIsThatOfTheReference) {
  const Photograph reference = random_grey(160, 80, 200, 1);
  const std::array<Photograph, 2> others = {random_grey(160, 80, 200, 2),
                                            random_grey(160, 80, 200, 3)};
  MatchOptions options = window_options({1, 12});
  options.roi = ImageRegion{70, 35, 20, 7};
  MatchOptions of_whole = options;
  of_whole.roi.reset();
  for (const double first : {1.0, -1.0}) {
    const std::array<OtherView, 2> views = {OtherView{&others[0], first},
                                            OtherView{&others[1], -2 * first}};
    DisparityMaps whole;
    DisparityMaps part;
    StereoMatcher(of_whole).match_several(reference, views, {}, whole);
    StereoMatcher(options).match_several(reference, views, {}, part);
    const Side side = first > 0 ? Side::kLeft : Side::kRight;
    expect_same_inside(part.of(side), whole.of(side), *options.roi);
  }
}

TEST(Region, OfDisplacementsHasThePartnerRows) {
  const Photograph left = random_grey(120, 110, 200, 1);
  const Photograph right = random_grey(120, 110, 200, 2);
  MatchOptions options = window_options({-3, 4});
  options.disparities_y = DisparityRange{1, 5};
  DisparityMaps whole;
  StereoMatcher(options).match(left, right, {}, whole);
  options.roi = ImageRegion{50, 55, 11, 5};
  DisparityMaps part;
  StereoMatcher(options).match(left, right, {.right = false}, part);
  expect_same_inside(part.left, whole.left, *options.roi);
  EXPECT_EQ(part.left.disparity_y_px.at(53, 57), whole.left.disparity_y_px.at(53, 57));
}

TEST(Region, IsRefusedOutsideTheImagesAndWithVolumes) {
  const Photograph image = random_grey(40, 30, 200, 1);
  MatchOptions options = window_options({0, 3});
  DisparityMaps maps;
  options.roi = ImageRegion{30, 0, 11, 10};
  EXPECT_THAT(
      [&] { StereoMatcher(options).match(image, image, {}, maps); },
      testing::ThrowsMessage<Error>("roi is 30,0,11,10, expected it inside the images of 40x30"));
  options.roi = ImageRegion{0, 0, 0, 10};
  EXPECT_THROW(options.validate(), UsageError);
  options.roi.reset();
  for (const double scale : {0.0, 1.01, -0.5, std::nan("")}) {
    options.scale = scale;
    EXPECT_THROW(options.validate(), UsageError) << scale;
  }
  options.scale = 0.5;
  const std::array<VolumeRequest, 1> volumes = {};
  EXPECT_THROW(StereoMatcher(options).match(image, image, {.volumes = volumes}, maps), UsageError);
}

/// A plane behind a square that is nearer, of smooth texture.
Photograph seen_from(int place) {
  Image<std::uint8_t> image(211, 150);
  for (const auto [x, y] : positions_of(211, 150)) {
    const int in_front = x + 21 * place;
    const bool is_square = in_front >= 90 && in_front < 150 && y >= 40 && y < 110;
    const double at = is_square ? in_front + 1000 : x + 8 * place;
    const double value = std::sin(at * 0.7 + y * 0.31) + std::sin(at * 0.23 - y * 0.53) +
                         std::sin(at * 0.061 + y * 0.11);
    image.at(x, y) = static_cast<std::uint8_t>(std::lround(127 + 40 * value));
  }
  return {std::move(image)};
}

TEST(Scale, MapsHaveTheDisparitiesOfTheGivenImages) {
  const Photograph left = seen_from(0);
  const Photograph right = seen_from(1);
  MatchOptions options;
  options.preset = MatchPreset::kBalanced;
  options.disparities = {0, 30};
  options.scale = 0.5;
  DisparityMaps maps;
  StereoMatcher(options).match(left, right, {.confidence = true}, maps);
  ASSERT_EQ(maps.left.disparity_px.width(), 211);
  ASSERT_EQ(maps.left.confidence.height(), 150);
  int good = 0;
  int all = 0;
  for (const auto [x, y] : positions_of({40, 200}, {5, 145})) {
    const bool is_square = x >= 90 && x < 150 && y >= 40 && y < 110;
    const bool is_hidden = x >= 75 && x < 90 && y >= 38 && y < 112;
    good += std::abs(maps.left.disparity_px.at(x, y) - (is_square ? 21 : 8)) < 1 ? 1 : 0;
    all += is_hidden ? 0 : 1;
  }
  EXPECT_GT(good, 0.97 * all);
}

}  // namespace vantage::matched_part_test
