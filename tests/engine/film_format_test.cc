#include "engine/io/video/film_format.h"

#include "engine/io/video/stated_format.h"
#include "engine/io/video/video_io.h"
#include "engine/io/video/writing/frame_conversion.h"
#include "engine/io/video/writing/video_join.h"
#include "tests/engine/engine_test.h"

extern "C" {
#include <libavutil/frame.h>
#include <libavutil/pixfmt.h>
}

namespace vantage::film_format_test {

constexpr int kWidth = 64;
constexpr int kHeight = 48;

const FilmFormat kPq = {
    .pixel_aspect = {4, 3},
    .colours = {.primaries = AVCOL_PRI_BT2020,
                .transfer = AVCOL_TRC_SMPTE2084,
                .matrix = AVCOL_SPC_BT2020_NCL,
                .bits = 10,
                .mastering_display =
                    "G(13250,34500)B(7500,3000)R(34000,16000)WP(15635,16450)L(10000000,50)",
                .light_level = "1000,400"}};
const FilmFormat kHlg = {.pixel_aspect = {},
                         .colours = {.primaries = AVCOL_PRI_SMPTE432,
                                     .transfer = AVCOL_TRC_ARIB_STD_B67,
                                     .matrix = AVCOL_SPC_BT2020_NCL,
                                     .bits = 10}};
const FilmFormat kSd = {.pixel_aspect = {16, 11},
                        .colours = {.primaries = AVCOL_PRI_SMPTE170M,
                                    .transfer = AVCOL_TRC_SMPTE170M,
                                    .matrix = AVCOL_SPC_SMPTE170M,
                                    .has_full_range = true}};

/// Saturated colours in blocks of 16 pixels, which change with the frame.
template <typename T>
Photograph blocks(int index) {
  constexpr int kWhite = std::numeric_limits<T>::max();
  Image<T> image(kWidth, kHeight, 3);
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    const int block = x / 16 + 4 * (y / 16) + index;
    for (int c = 0; c < 3; ++c) {
      image.at(x, y, c) = static_cast<T>(kWhite * (1 + (block * (2 + 3 * c)) % 7) / 8);
    }
  }
  return {std::move(image)};
}

template <typename T>
void write_film(const std::filesystem::path& path, const FilmFormat& format) {
  VideoWriter writer(
      path, kWidth, kHeight,
      {.rate = {}, .crf = 2, .coding = colour_coding(format.colours), .format = format});
  for (int i = 0; i < 3; ++i) {
    writer.write(blocks<T>(i));
  }
  writer.finish();
}

/// Largest difference in the middle of blocks, in shares of white.
template <typename T>
double largest_difference(const Photograph& actual, const Photograph& expected) {
  const auto& a = std::get<Image<T>>(actual.pixels);
  const auto& b = std::get<Image<T>>(expected.pixels);
  double largest = 0;
  for (int y = 8; y < kHeight; y += 16) {
    for (int x = 8; x < kWidth; x += 16) {
      for (int c = 0; c < 3; ++c) {
        largest = std::max(largest, std::abs(double{1} * a.at(x, y, c) - b.at(x, y, c)));
      }
    }
  }
  return largest / std::numeric_limits<T>::max();
}

template <typename T>
void expect_kept(const FilmFormat& format, double tolerance) {
  const TemporaryFolder folder;
  write_film<T>(folder / "a.mp4", format);
  write_film<T>(folder / "b.mp4", format);
  const std::vector<std::filesystem::path> segments = {folder / "a.mp4", folder / "b.mp4"};
  join_videos(segments, {}, {}, folder / "joined.mp4");
  for (const char* name : {"a.mp4", "joined.mp4"}) {
    VideoReader reader(folder / name);
    EXPECT_EQ(reader.film_format(), format) << name << ": " << to_text(reader.film_format());
    Photograph frame;
    for (int i = 0; i < reader.frame_count(); ++i) {
      ASSERT_TRUE(reader.read(frame));
      EXPECT_LT(largest_difference<T>(frame, blocks<T>(i % 3)), tolerance) << name << " " << i;
    }
  }
}

TEST(FilmFormats, PqWithItsDisplayIsKept) { expect_kept<std::uint16_t>(kPq, 0.006); }
TEST(FilmFormats, HlgIsKept) { expect_kept<std::uint16_t>(kHlg, 0.006); }
TEST(FilmFormats, FullRangeBt601IsKept) { expect_kept<std::uint8_t>(kSd, 0.02); }

TEST(FilmFormats, HdrInEightBitsIsToneMapped) {
  // Grey of these luminances by SMPTE ST 2084, mapped by Hable's curve and coded by BT.1886.
  constexpr std::array kLuminances = {10.0, 100.0, 203.0, 400.0, 1000.0};
  const auto code_of = [](double luminance) {
    const double y = std::pow(luminance / 10000, 0.1593017578125);
    return std::pow((0.8359375 + 18.8515625 * y) / (1 + 18.6875 * y), 78.84375);
  };
  const auto curve = [](double x) {
    return (x * (x * 0.15 + 0.05) + 0.004) / (x * (x * 0.15 + 0.5) + 0.06) - 0.02 / 0.3;
  };
  const TemporaryFolder folder;
  VideoWriter writer(folder / "a.mp4", kWidth, kHeight, {.rate = {}, .crf = 2, .format = kPq});
  for (const double luminance : kLuminances) {
    Image<std::uint16_t> grey(kWidth, kHeight, 3);
    grey.fill(static_cast<std::uint16_t>(std::lround(65535 * code_of(luminance))));
    writer.write(Photograph{std::move(grey)});
  }
  writer.finish();
  VideoReader reader(folder / "a.mp4");
  const FilmFormat expected = {
      .pixel_aspect = kPq.pixel_aspect,
      .colours = {
          .primaries = AVCOL_PRI_BT709, .transfer = AVCOL_TRC_BT709, .matrix = AVCOL_SPC_BT709}};
  EXPECT_EQ(reader.film_format(), expected);
  Photograph frame;
  for (const double luminance : kLuminances) {
    ASSERT_TRUE(reader.read(frame));
    const auto& image = std::get<Image<std::uint8_t>>(frame.pixels);
    EXPECT_NEAR(image.at(kWidth / 2, kHeight / 2, 1) / 255.0,
                std::pow(curve(luminance / 100) / curve(10), 1 / 2.4), 0.01)
        << luminance;
  }
}

TEST(FilmFormats, WhatStatesNothingIsBt709) {
  FilmColours usual = {
      .primaries = AVCOL_PRI_BT709, .transfer = AVCOL_TRC_BT709, .matrix = AVCOL_SPC_BT709};
  EXPECT_EQ(written_colours({}, VideoCoding::kH264), usual);
  EXPECT_EQ(written_colours({.matrix = AVCOL_SPC_BT709}, VideoCoding::kH264), usual);
  EXPECT_EQ(written_colours({.matrix = AVCOL_SPC_RGB}, VideoCoding::kH264), usual);
  // Of a film of BT.601 nobody knows which primaries: none are stated.
  const FilmColours sd = {.matrix = AVCOL_SPC_SMPTE170M};
  EXPECT_EQ(written_colours(sd, VideoCoding::kH264), sd);
  EXPECT_EQ(to_text(FilmFormat{}), "");
  EXPECT_EQ(to_text(kPq),
            "pixels 4:3, 10 bits, primaries bt2020, transfer smpte2084, matrix bt2020nc");
}

TEST(FilmFormats, CodesAreThoseOfTheStandard) {
  // ITU-R BT.2020, table 4 and 5, with 10 bits.
  const FrameConversion convert =
      make_frame_conversion(VideoCoding::kHevcColours_10, kWidth, kHeight, kPq.colours);
  const Photograph picture = blocks<std::uint16_t>(1);
  const LibavFrame converted = convert(picture);
  const AVFrame& frame = *converted;
  const auto& image = std::get<Image<std::uint16_t>>(picture.pixels);
  const auto code = [&](int plane, int x, int y) {
    return reinterpret_cast<const std::uint16_t*>(frame.data[plane] + y * frame.linesize[plane])[x];
  };
  for (int y = 8; y < kHeight; y += 16) {
    for (int x = 8; x < kWidth; x += 16) {
      const double red = image.at(x, y, 0) / 65535.0;
      const double green = image.at(x, y, 1) / 65535.0;
      const double blue = image.at(x, y, 2) / 65535.0;
      const double luma = 0.2627 * red + 0.6780 * green + 0.0593 * blue;
      EXPECT_NEAR(code(0, x, y), 64 + 876 * luma, 1.2);
      EXPECT_NEAR(code(1, x / 2, y / 2), 512 + 896 * (blue - luma) / 1.8814, 1.2);
      EXPECT_NEAR(code(2, x / 2, y / 2), 512 + 896 * (red - luma) / 1.4746, 1.2);
    }
  }
}

}  // namespace vantage::film_format_test
