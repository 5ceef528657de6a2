#include "engine/matching/pair_matcher.h"

#include "engine/image/pixel_buffer.h"
#include "engine/matching/range_estimation.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/random_grey.h"

namespace vantage::pair_matcher_test {

constexpr int kWidth = 61;
constexpr int kHeight = 37;

/// Random colours in exactly as many bytes as they need, so that the sanitizer sees every access
/// beyond them. The right image is shifted by 4 pixels.
template <typename T>
std::vector<T> colours(int shift, int channels, T max) {
  std::vector<T> values;
  for (const auto [x, y] : positions_of({shift, kWidth + shift}, {0, kHeight})) {
    for (int c = 0; c < channels; ++c) {
      const unsigned hash =
          (static_cast<unsigned>(y * 977 + x) * 2654435761U + static_cast<unsigned>(c) * 40503U) >>
          8U;
      values.push_back(static_cast<T>(static_cast<double>(max) * (hash % 251) / 250));
    }
  }
  return values;
}

template <typename T>
PixelBuffer<T> buffer_of(const std::vector<T>& values, int channels) {
  return {.data = values.data(), .width_px = kWidth, .height_px = kHeight, .channels = channels};
}

template <typename T>
const T* first_pixel(const Photograph& photograph) {
  return std::get<Image<T>>(photograph.pixels).row(0);
}

MatchOptions options_of(MatchPreset preset) {
  MatchOptions options;
  options.preset = preset;
  options.disparities = {0, 15};
  return options;
}

template <typename T>
void expect_borrowed_pixels_match_alike(T max) {
  for (const int channels : {1, 3, 4}) {
    const std::vector<T> left = colours<T>(0, channels, max);
    const std::vector<T> right = colours<T>(4, channels, max);
    for (const MatchPreset preset : {MatchPreset::kRealtime, MatchPreset::kQuality}) {
      const PairMatcher matcher(options_of(preset));
      const Photograph borrowed = photograph_of(buffer_of(left, channels));
      EXPECT_EQ(first_pixel<T>(borrowed), left.data());
      const Photograph copied = copied_photograph(buffer_of(left, channels));
      EXPECT_NE(first_pixel<T>(copied), left.data());
      DisparityMaps of_borrowed;
      DisparityMaps of_copies;
      matcher.match(borrowed, photograph_of(buffer_of(right, channels)), {}, of_borrowed);
      matcher.match(copied, copied_photograph(buffer_of(right, channels)), {}, of_copies);
      EXPECT_TRUE(identical(of_borrowed.left.disparity_px, of_copies.left.disparity_px));
      EXPECT_TRUE(identical(of_borrowed.right.disparity_px, of_copies.right.disparity_px));
    }
  }
}

TEST(PixelBufferTest, BorrowedPixelsMatchAlike) {
  expect_borrowed_pixels_match_alike<std::uint8_t>(255);
  expect_borrowed_pixels_match_alike<std::uint16_t>(65535);
  expect_borrowed_pixels_match_alike<float>(1);
}

TEST(PixelBufferTest, OtherLayoutsAreCopied) {
  const std::vector<std::uint8_t> values = colours<std::uint8_t>(0, 3, 255);
  PixelBuffer<std::uint8_t> buffer = buffer_of(values, 3);
  const Photograph plain = photograph_of(buffer);
  buffer.order = ChannelOrder::kBgr;
  const Photograph bgr = photograph_of(buffer);
  buffer = {.data = values.data() + 3 * kWidth * (kHeight - 1),
            .width_px = kWidth,
            .height_px = kHeight,
            .channels = 3,
            .row_bytes = -3 * kWidth};
  const Photograph upside_down = photograph_of(buffer);
  const auto at = [](const Photograph& photograph, int x, int y, int channel) {
    return std::get<Image<std::uint8_t>>(photograph.pixels).at(x, y, channel);
  };
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(at(bgr, 5, 7, c), at(plain, 5, 7, 2 - c));
    EXPECT_EQ(at(upside_down, 5, 7, c), at(plain, 5, kHeight - 8, c));
  }
}

TEST(PixelBufferTest, RefusesWhatNoPhotographHas) {
  std::vector<float> values(12, 0.5F);
  const auto expect_refused = [&](PixelBuffer<float> buffer, const char* message) {
    EXPECT_THAT(error_of([&] { (void)photograph_of(buffer); }), HasSubstr(message));
  };
  expect_refused({.data = values.data(), .width_px = 0, .height_px = 3}, "0x3 pixels");
  expect_refused({.data = values.data(), .width_px = 2, .height_px = 2, .channels = 2},
                 "2 channels");
  expect_refused({.width_px = 2, .height_px = 2}, "no pixels");
  values[5] = std::numeric_limits<float>::infinity();
  expect_refused({.data = values.data(), .width_px = 4, .height_px = 3},
                 "inf at pixel (1, 1), expected finite values");
}

TEST(PairMatcherTest, FindsTheRangeOfEachPair) {
  MatchOptions options = options_of(MatchPreset::kRealtime);
  options.disparities_auto = true;
  const PairMatcher matcher(options);
  for (const int shift : {4, 9, 4}) {
    const std::vector<std::uint8_t> left = colours<std::uint8_t>(0, 1, 255);
    const std::vector<std::uint8_t> right = colours<std::uint8_t>(shift, 1, 255);
    const Photograph images[] = {photograph_of(buffer_of(left, 1)),
                                 photograph_of(buffer_of(right, 1))};
    DisparityMaps maps;
    const MatchOptions used = matcher.match(images[0], images[1], {}, maps);
    EXPECT_EQ(used.disparities,
              estimate_disparity_range(images[0], images[1], default_execution()));
    EXPECT_FALSE(used.disparities_auto);
    DisparityMaps expected;
    StereoMatcher(used).match(images[0], images[1], {}, expected);
    EXPECT_TRUE(identical(maps.left.disparity_px, expected.left.disparity_px));
    EXPECT_NEAR(maps.left.disparity_px.at(kWidth / 2, kHeight / 2), shift, 0.5);
  }
}

TEST(PairMatcherTest, WithoutARequestTheMapIsThatOfTheReference) {
  const std::vector<std::uint8_t> left = colours<std::uint8_t>(0, 1, 255);
  const std::vector<std::uint8_t> right = colours<std::uint8_t>(4, 1, 255);
  const Photograph left_image = photograph_of(buffer_of(left, 1));
  const Photograph right_image = photograph_of(buffer_of(right, 1));
  MatchOptions options = options_of(MatchPreset::kRealtime);
  DisparityMaps both;
  PairMatcher(options).match(left_image, right_image, {}, both);
  MatchedMap map;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    options.reference = side;
    PairMatcher(options).match(left_image, right_image, map);
    EXPECT_TRUE(identical(map.disparity_px, both.of(side).disparity_px));
    EXPECT_TRUE(identical(map.unmatched, both.of(side).unmatched));
  }
  EXPECT_FALSE(identical(map.disparity_px, both.left.disparity_px));
}

}  // namespace vantage::pair_matcher_test
