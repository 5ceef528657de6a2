#include "engine/io/video/chroma_upsampler.h"

#include <algorithm>
#include <cstddef>

#include "engine/io/video/libav_scaler.h"
#include "kernels/chroma_upsampling/chroma_upsampling.h"

extern "C" {
#include <libavutil/frame.h>
#include <libavutil/pixdesc.h>
}

namespace vantage {
namespace {

/// Weights of the four chroma rows around row y of the picture. Where the outermost chroma row
/// would lie above the picture, libswscale drops it and scales up the weights of the others. At all
/// other borders it repeats the border row.
kernels::ChromaWeights weights_of(int y) {
  const auto [far, near, nearest, next] = kernels::kChromaWeights;
  return y == 0       ? kernels::ChromaWeights{0, 0, 4432, -336}
         : y == 2     ? kernels::ChromaWeights{0, 959, 3473, -336}
         : y % 2 == 0 ? kernels::kChromaWeights
                      : kernels::ChromaWeights{next, nearest, near, far};
}

}  // namespace

bool ChromaUpsampler::serves(const AVFrame& frame) {
  const ChromaPosition chroma =
      chroma_position(frame.chroma_location, describe_pixel_format(frame.format));
  constexpr int kSmallest = 14;  // libswscale takes fewer taps in smaller ones
  return std::min(frame.width, frame.height) >= kSmallest &&
         (frame.format == AV_PIX_FMT_YUV420P || frame.format == AV_PIX_FMT_YUVJ420P) &&
         frame.width % 2 == 0 && frame.height % 2 == 0 && chroma.x == 0 && chroma.y == 128;
}

void ChromaUpsampler::begin(const AVFrame& frame) {
  frame_ = &frame;
  next_row_ = 0;
  rows_made_ = 0;
  columns_.resize(std::size_t{8} * static_cast<std::size_t>(frame.width));
  row_.resize(std::size_t{3} * static_cast<std::size_t>(frame.width));
}

kernels::LumaChromaRow ChromaUpsampler::next_row() {
  const int y = next_row_++;
  const int width = frame_->width;
  const int chroma_rows = frame_->height / 2;
  const auto columns = [&](int plane, int row) {
    return columns_.data() + std::ptrdiff_t{width} * (4 * (plane - 1) + row % 4);
  };
  const int first = (y + 1) / 2 - 2;
  for (; rows_made_ < std::min(first + 4, chroma_rows); ++rows_made_) {
    for (int plane = 1; plane <= 2; ++plane) {
      kernels::chroma_columns(
          frame_->data[plane] + std::ptrdiff_t{rows_made_} * frame_->linesize[plane], width / 2,
          columns(plane, rows_made_));
    }
  }
  const std::uint8_t* luma = frame_->data[0] + std::ptrdiff_t{y} * frame_->linesize[0];
  std::uint16_t* __restrict luma_16 = row_.data();
  for (int x = 0; x < width; ++x) {
    luma_16[x] = static_cast<std::uint16_t>(luma[x] << 8);
  }
  for (int plane = 1; plane <= 2; ++plane) {
    kernels::ChromaSourceRows rows;
    for (int k = 0; k < 4; ++k) {
      rows[static_cast<std::size_t>(k)] = columns(plane, std::clamp(first + k, 0, chroma_rows - 1));
    }
    kernels::chroma_row(rows, weights_of(y), width, row_.data() + std::ptrdiff_t{plane} * width);
  }
  return {row_.data(), row_.data() + width, row_.data() + 2 * std::ptrdiff_t{width}, width};
}

}  // namespace vantage
