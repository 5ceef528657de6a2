

#include "engine/comfort/comfort_summary.h"
#include "engine/comfort/frame_comfort.h"
#include "engine/comfort/image_order.h"
#include "tests/engine/engine_test.h"

namespace vantage::comfort_test {

constexpr int kWidth = 200;
constexpr int kHeight = 20;

Photograph grey_image(int level) {
  Image<std::uint8_t> image(kWidth, kHeight);
  image.fill(static_cast<std::uint8_t>(level));
  return Photograph{std::move(image)};
}

MatchedMap map_of(float disparity_px) {
  MatchedMap map;
  map.disparity_px.resize(kWidth, kHeight);
  map.disparity_px.fill(disparity_px);
  map.unmatched.resize(kWidth, kHeight);
  map.unmatched.fill(0);
  return map;
}

TEST(FrameComfort, CountsMatchedPixelsOnly) {
  MatchedMap map = map_of(-2);
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    map.disparity_px.at(x, y) = x < 50    ? std::numeric_limits<float>::quiet_NaN()
                                : x < 60  ? 100.0F  // unmatched
                                : x < 130 ? 1.5F
                                          : -2.0F;
    map.unmatched.at(x, y) = x >= 50 && x < 60 ? 255 : 0;
  }
  const FrameComfort comfort = measure_comfort(grey_image(90), grey_image(80), map, Side::kLeft);
  EXPECT_EQ(comfort.matched, 7000);
  EXPECT_EQ(comfort.disparity.front(), -2 * kComfortPerPixel);
  EXPECT_EQ(comfort.disparity.back(), 3 * kComfortPerPixel / 2);
  EXPECT_EQ(comfort.disparity[7], -2 * kComfortPerPixel);  // the lower half
  EXPECT_EQ(comfort.disparity[9], 3 * kComfortPerPixel / 2);
  for (const int difference : comfort.colour) {
    EXPECT_EQ(difference, 10 * kComfortPerGreyLevel);
  }
  EXPECT_FALSE(comfort.vertical);  // nothing to find in grey images
}

TEST(FrameComfort, ABorderCutsWhatIsInFrontAndTouchesItForTheOtherEye) {
  const Photograph image = grey_image(90);
  MatchedMap map = map_of(0);
  for (int y = 0; y < kHeight / 4; ++y) {
    map.disparity_px.at(11, y) = 10;  // at column 1 of the right image
  }
  for (int y = 0; y < kHeight / 2; ++y) {
    map.disparity_px.at(kWidth - 1, y) = 6;
    map.disparity_px.at(0, y) = -8;  // behind the screen
  }
  const auto borders = measure_comfort(image, image, map, Side::kLeft).borders;
  EXPECT_EQ(borders[0].rows, kComfortWhole / 4);
  EXPECT_EQ(borders[0].disparity, 10 * kComfortPerPixel);
  EXPECT_EQ(borders[1].rows, kComfortWhole / 2);
  EXPECT_EQ(borders[1].disparity, 6 * kComfortPerPixel);
  // The same in the map of the right image.
  MatchedMap right = map_of(0);
  for (int y = 0; y < kHeight / 4; ++y) {
    right.disparity_px.at(1, y) = 10;
  }
  EXPECT_EQ(measure_comfort(image, image, right, Side::kRight).borders[0].rows, kComfortWhole / 4);
}

/// A near square [80, 120) in front of a background of another level. What the square hides from
/// the right eye, [70, 80), has the background's level, or the square's if the images are
/// exchanged.
OrderVotes votes_with(int hidden_level) {
  Image<std::uint8_t> image(kWidth, kHeight);
  MatchedMap map = map_of(2);
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    const bool is_near = x >= 80 && x < 120;
    const bool is_hidden = x >= 70 && x < 80;
    image.at(x, y) = static_cast<std::uint8_t>(is_hidden ? hidden_level : is_near ? 200 : 50);
    map.disparity_px.at(x, y) = is_near ? 12 : 2;
    map.unmatched.at(x, y) = is_hidden ? 255 : 0;
  }
  return order_of_images(Photograph{std::move(image)}, map, Side::kLeft);
}

TEST(ImageOrder, HiddenPixelsBelongToWhatIsFarther) {
  EXPECT_EQ(votes_with(50).right, kHeight);
  EXPECT_EQ(votes_with(50).wrong, 0);
  EXPECT_EQ(votes_with(200).right, 0);
  EXPECT_EQ(votes_with(200).wrong, kHeight);
  EXPECT_EQ(votes_with(125).right + votes_with(125).wrong, 0);  // no clear difference
}

FrameComfort frame_at(int disparity_px) {
  FrameComfort frame;
  frame.width_px = 1000;
  frame.height_px = 500;
  frame.matched = kComfortWhole;
  frame.disparity.fill(disparity_px * kComfortPerPixel);
  return frame;
}

TEST(ComfortSummary, JudgesByShareOfTheWidthAndByTheJumpAtACut) {
  // Shots of one disparity each: 8 px (0.8 % of the width), 40 px in front, 15 px behind.
  std::map<int, FrameComfort> frames;
  for (int frame = 0; frame < 6; ++frame) {
    frames[frame] = frame_at(frame < 2 ? 8 : frame < 4 ? 40 : -15);
  }
  const ComfortReport report = summarise_comfort(frames, {{0, 2}, {2, 4}, {4, 6}, {6, 9}});
  ASSERT_EQ(report.shots.size(), 3);  // the last span has no frames
  EXPECT_EQ(report.shots[0].verdict, ComfortVerdict::kSafe);
  EXPECT_NEAR(report.shots[0].percentiles_px[2], 8, 0.01);
  EXPECT_FALSE(report.shots[0].jump_px);
  EXPECT_NEAR(report.shots[1].crossed_percent, 4.0, 1e-3);
  EXPECT_EQ(report.shots[1].verdict, ComfortVerdict::kUnsafe);
  EXPECT_EQ(report.shots[1].jump_px, 32);
  EXPECT_NEAR(report.shots[2].uncrossed_percent, 1.5, 1e-3);
  EXPECT_EQ(report.shots[2].jump_px, -55);
  EXPECT_EQ(report.film.frames, 6);
  EXPECT_EQ(report.film.verdict, ComfortVerdict::kUnsafe);
  EXPECT_NEAR(report.film.percentiles_px[0], -15, 0.01);
  EXPECT_NEAR(report.film.percentiles_px[4], 40, 0.01);
}

TEST(ComfortSummary, ManyWrongPlacesAreExchangedImages) {
  FrameComfort frame = frame_at(0);
  frame.order_right = 10;
  frame.order_wrong = 1000;
  EXPECT_TRUE(summarise_comfort({{0, frame}}, {{0, 1}}).film.exchanged);
  std::swap(frame.order_right, frame.order_wrong);
  EXPECT_FALSE(summarise_comfort({{0, frame}}, {{0, 1}}).film.exchanged);
}

}  // namespace vantage::comfort_test
