#pragma once

#include "engine/io/images/photograph_io.h"
#include "engine/io/video/frame_source.h"
#include "engine/io/video/libav_scaler.h"
#include "engine/io/video/video_io.h"
#include "tests/engine/engine_test.h"

extern "C" {
#include <libavutil/frame.h>
#include <libavutil/pixfmt.h>
}

namespace vantage {
inline namespace test {

/// One value everywhere.
inline Photograph plain_photograph(int width, int height, int value) {
  Photograph photograph{Image<std::uint8_t>(width, height)};
  std::get<Image<std::uint8_t>>(photograph.pixels).fill(static_cast<std::uint8_t>(value));
  return photograph;
}

/// The same as a picture of a video.
inline VideoPicture plain_picture(int width, int height, int value) {
  const LibavFrame frame = make_picture(width, height, AV_PIX_FMT_GRAY8);
  for (int y = 0; y < height; ++y) {
    std::fill_n(frame->data[0] + std::ptrdiff_t{y} * frame->linesize[0], width,
                static_cast<std::uint8_t>(value));
  }
  return {*frame, std::make_shared<PictureConverters>(), "made-up video"};
}

/// A 2×1 image whose value tells it from the others.
inline void put_image(const std::filesystem::path& path, int value) {
  write_photograph(path, plain_photograph(2, 1, value));
}

/// Images folder/000000.png … of these values; −1: none under that number.
inline void put_images(const std::filesystem::path& folder, const std::vector<int>& values) {
  std::filesystem::create_directories(folder);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string number = std::to_string(i);
    if (values[i] >= 0) {
      put_image(folder / (std::string(6 - number.size(), '0') + number + ".png"), values[i]);
    }
  }
}

/// A 32×32 video whose frames have these values, but for rounding by the codec.
inline void put_video(const std::filesystem::path& path, const std::vector<int>& values,
                      FrameRate rate = {25, 1}) {
  VideoWriter writer(path, 32, 32, {.rate = rate});
  for (const int value : values) {
    writer.write(plain_photograph(32, 32, value));
  }
  writer.finish();
}

/// The value of the first pixel.
inline int value_of(const Photograph& photograph) {
  return std::get<Image<std::uint8_t>>(photograph.pixels).at(0, 0);
}

/// Those of all frames that are left.
inline std::vector<int> values_of(FrameSource& source) {
  std::vector<int> values;
  Photograph frame;
  while (source.next(frame)) {
    values.push_back(value_of(frame));
  }
  return values;
}

}  // namespace test
}  // namespace vantage
