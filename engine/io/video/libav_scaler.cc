#include "engine/io/video/libav_scaler.h"

#include <algorithm>
#include <array>
#include <new>
#include <utility>

#include "engine/error.h"
#include "engine/io/video/libav_functions.h"

extern "C" {
#include <libavutil/frame.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

namespace vantage {
namespace {

constexpr int kScalerFlags =
    SWS_BICUBIC | SWS_ACCURATE_RND | SWS_BITEXACT | SWS_FULL_CHR_H_INT | SWS_FULL_CHR_H_INP;

}  // namespace

ChromaPosition chroma_position(int location, const AVPixFmtDescriptor& format) {
  ChromaPosition position;
  const bool centred = location == AVCHROMA_LOC_CENTER || location == AVCHROMA_LOC_TOP ||
                       location == AVCHROMA_LOC_BOTTOM;
  const bool at_top = location == AVCHROMA_LOC_TOP || location == AVCHROMA_LOC_TOPLEFT;
  const bool at_bottom = location == AVCHROMA_LOC_BOTTOM || location == AVCHROMA_LOC_BOTTOMLEFT;
  if (format.log2_chroma_w == 1 && centred) {
    position.x = 128;
  }
  if (format.log2_chroma_h == 1) {
    position.y = at_top ? 0 : at_bottom ? 256 : 128;
  }
  return position;
}

const AVPixFmtDescriptor& describe_pixel_format(int format) {
  const AVPixFmtDescriptor* description =
      libav().av_pix_fmt_desc_get(static_cast<AVPixelFormat>(format));
  if (description == nullptr) {
    throw Error("its pixel format is unknown");
  }
  return *description;
}

LibavScaler make_scaler(const ScalerOptions& options) {
  LibavScaler scaler(libav().sws_alloc_context());
  if (scaler == nullptr) {
    throw std::bad_alloc();
  }
  const std::array<std::pair<const char*, int>, 13> settings = {{
      {"srcw", options.width},
      {"srch", options.height},
      {"src_format", options.source_format},
      {"src_range", options.source_full_range ? 1 : 0},
      {"src_h_chr_pos", options.source_chroma.x},
      {"src_v_chr_pos", options.source_chroma.y},
      {"dstw", options.width},
      {"dsth", options.height},
      {"dst_format", options.target_format},
      {"dst_range", options.target_full_range ? 1 : 0},
      {"dst_h_chr_pos", options.target_chroma.x},
      {"dst_v_chr_pos", options.target_chroma.y},
      {"sws_flags", kScalerFlags},
  }};
  for (const auto& [name, value] : settings) {
    libav().av_opt_set_int(scaler.get(), name, value, 0);
  }
  const int* coefficients = libav().sws_getCoefficients(options.matrix);
  constexpr int kOne = 1 << 16;
  if (libav().sws_init_context(scaler.get(), nullptr, nullptr) < 0) {
    throw Error("its pixel format cannot be converted");
  }
  // Fails if there is nothing to set: between two kinds of RGB.
  libav().sws_setColorspaceDetails(scaler.get(), coefficients, options.source_full_range ? 1 : 0,
                                   coefficients, options.target_full_range ? 1 : 0, 0, kOne, kOne);
  return scaler;
}

LibavFrame make_picture(int width, int height, int format) {
  LibavFrame frame = make_libav_frame();
  frame->width = width;
  frame->height = height;
  frame->format = format;
  if (libav().av_frame_get_buffer(frame.get(), 0) < 0) {
    throw std::bad_alloc();
  }
  return frame;
}

PicturePool::PicturePool(int width, int height, int format)
    : width_(width), height_(height), format_(format) {}

LibavFrame PicturePool::make() {
  const auto idle = std::ranges::find_if(frames_, [](const LibavFrame& frame) {
    return libav().av_frame_is_writable(frame.get()) != 0;
  });
  if (idle != frames_.end()) {
    return another_reference(**idle);
  }
  frames_.push_back(make_picture(width_, height_, format_));
  return another_reference(*frames_.back());
}

}  // namespace vantage
