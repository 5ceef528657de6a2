#include "engine/io/video/photograph_to_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <new>
#include <type_traits>

#include "engine/io/video/libav_scaler.h"

extern "C" {
#include <libavutil/frame.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

namespace vantage {
namespace {

/// 8-bit value from any depth, rounded.
template <typename T>
std::uint8_t to_byte(T value) {
  if constexpr (std::is_same_v<T, std::uint8_t>) {
    return value;
  } else if constexpr (std::is_same_v<T, std::uint16_t>) {
    return static_cast<std::uint8_t>((value * 255U + 32767U) / 65535U);
  } else {
    return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(value, 0.0F, 1.0F)));
  }
}

/// Fills `rgb`, which may be a column and a row larger than the image: those repeat the last.
template <typename T>
void fill_rgb(const Image<T>& image, AVFrame& rgb) {
  const int channels = image.channels();
  const int green = channels >= 3 ? 1 : 0;
  const int blue = channels >= 3 ? 2 : 0;
  for (int y = 0; y < rgb.height; ++y) {
    const T* source = image.row(std::min(y, image.height() - 1));
    std::uint8_t* target = rgb.data[0] + std::ptrdiff_t{y} * rgb.linesize[0];
    for (int x = 0; x < rgb.width; ++x) {
      const T* pixel = source + std::min(x, image.width() - 1) * channels;
      target[3 * x] = to_byte(pixel[0]);
      target[3 * x + 1] = to_byte(pixel[green]);
      target[3 * x + 2] = to_byte(pixel[blue]);
    }
  }
}

}  // namespace

PhotographToFrame::PhotographToFrame(int width, int height)
    : width_((width + 1) / 2 * 2), height_((height + 1) / 2 * 2) {
  rgb_ = make_picture(width_, height_, AV_PIX_FMT_RGB24);
  yuv_ = make_picture(width_, height_, AV_PIX_FMT_YUV420P);
  yuv_->colorspace = AVCOL_SPC_BT709;
  yuv_->color_range = AVCOL_RANGE_MPEG;
  yuv_->chroma_location = AVCHROMA_LOC_LEFT;
  scaler_ = make_scaler(
      {.width = width_,
       .height = height_,
       .source_format = AV_PIX_FMT_RGB24,
       .target_format = AV_PIX_FMT_YUV420P,
       .target_full_range = false,
       .target_chroma = chroma_position(AVCHROMA_LOC_LEFT, describe_pixel_format(yuv_->format))});
}

AVFrame& PhotographToFrame::convert(const Photograph& photograph) {
  if (av_frame_make_writable(yuv_.get()) < 0) {
    throw std::bad_alloc();
  }
  const auto* bytes = std::get_if<Image<std::uint8_t>>(&photograph.pixels);
  if (bytes != nullptr && bytes->channels() == 3 && bytes->width() == width_ &&
      bytes->height() == height_) {
    const std::array<const std::uint8_t*, 4> rgb = {bytes->row(0)};
    const std::array<int, 4> pitch = {static_cast<int>(bytes->view().stride())};
    sws_scale(scaler_.get(), rgb.data(), pitch.data(), 0, height_, yuv_->data, yuv_->linesize);
    return *yuv_;
  }
  std::visit([&](const auto& image) { fill_rgb(image, *rgb_); }, photograph.pixels);
  sws_scale(scaler_.get(), rgb_->data, rgb_->linesize, 0, height_, yuv_->data, yuv_->linesize);
  return *yuv_;
}

}  // namespace vantage
