#include "engine/io/video/grey_to_frame.h"

#include <algorithm>
#include <cstddef>
#include <new>

#include "engine/error.h"
#include "engine/io/video/libav_scaler.h"

extern "C" {
#include <libavutil/frame.h>
#include <libavutil/pixfmt.h>
}

namespace vantage {
namespace {

constexpr unsigned kBlack = 64;      // of limited range, 10 bits
constexpr unsigned kLumaSpan = 876;  // from black to white
constexpr std::uint16_t kNoChroma = 512;

std::uint16_t code_of(VideoCoding coding, std::uint16_t value) {
  if (coding == VideoCoding::kFfv1_16) {
    return value;
  }
  const std::uint16_t code = ten_bits(value);
  return coding == VideoCoding::kProRes_10
             ? static_cast<std::uint16_t>(kBlack + (code * kLumaSpan + 511) / 1023)
             : code;
}

std::uint16_t* code_row(AVFrame& frame, int plane, int y) {
  return reinterpret_cast<std::uint16_t*>(frame.data[plane] +
                                          std::ptrdiff_t{y} * frame.linesize[plane]);
}

}  // namespace

int pixel_format_of(VideoCoding coding) {
  switch (coding) {
    case VideoCoding::kFfv1_16:
      return AV_PIX_FMT_GRAY16LE;
    case VideoCoding::kProRes_10:
      return AV_PIX_FMT_YUV422P10LE;
    case VideoCoding::kH264:
      return AV_PIX_FMT_YUV420P;
    case VideoCoding::kFfv1_10:
    case VideoCoding::kHevc_10:
      break;
  }
  return AV_PIX_FMT_GRAY10LE;
}

GreyToFrame::GreyToFrame(VideoCoding coding, int width, int height) : coding_(coding) {
  const auto side = [&](int px) { return takes_odd_sizes(coding) ? px : (px + 1) / 2 * 2; };
  frame_ = make_picture(side(width), side(height), pixel_format_of(coding));
  frame_->color_range = coding == VideoCoding::kProRes_10 ? AVCOL_RANGE_MPEG : AVCOL_RANGE_JPEG;
}

AVFrame& GreyToFrame::convert(const Photograph& photograph) {
  const auto* grey = std::get_if<Image<std::uint16_t>>(&photograph.pixels);
  if (grey == nullptr || grey->channels() != 1) {
    throw Error("a frame of a grey video has colours or another depth, expected 16-bit grey");
  }
  if (av_frame_make_writable(frame_.get()) < 0) {
    throw std::bad_alloc();
  }
  for (int y = 0; y < frame_->height; ++y) {
    const std::uint16_t* source = grey->row(std::min(y, grey->height() - 1));
    std::uint16_t* target = code_row(*frame_, 0, y);
    for (int x = 0; x < frame_->width; ++x) {
      target[x] = code_of(coding_, source[std::min(x, grey->width() - 1)]);
    }
    if (coding_ == VideoCoding::kProRes_10) {
      std::fill_n(code_row(*frame_, 1, y), frame_->width / 2, kNoChroma);
      std::fill_n(code_row(*frame_, 2, y), frame_->width / 2, kNoChroma);
    }
  }
  return *frame_;
}

}  // namespace vantage
