#include "engine/io/video/video_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "engine/error.h"
#include "engine/io/video/libav_scaler.h"

extern "C" {
#include <libavutil/frame.h>
#include <libavutil/pixdesc.h>
#include <libavutil/video_enc_params.h>
}

namespace vantage {
namespace {

/// Of the blocks, by their area.
double mean_qp(AVVideoEncParams& parameters) {
  double sum = 0;
  double area = 0;
  for (unsigned i = 0; i < parameters.nb_blocks; ++i) {
    const AVVideoBlockParams& block = *av_video_enc_params_block(&parameters, i);
    const double block_area = static_cast<double>(block.w) * block.h;
    sum += block_area * block.delta_qp;
    area += block_area;
  }
  return parameters.qp + (area > 0 ? sum / area : 0);
}

/// In units of the samples.
double step_of(AVVideoEncParamsType type, double qp) {
  switch (type) {
    case AV_VIDEO_ENC_PARAMS_H264:
      return std::exp2((qp - 4) / 6);
    case AV_VIDEO_ENC_PARAMS_MPEG2:
      return qp;  // of a weight of 16, which the lowest frequencies have
    case AV_VIDEO_ENC_PARAMS_VP9:
      // The standard's table to within 8 %; its transforms are 8 times orthonormal ones.
      return (qp <= 95 ? qp + 7 : 102 * std::exp(0.018 * (qp - 95))) / 8;
    default:
      return 0;
  }
}

/// The mean QP of the blocks is there where the decoder exports it: FFmpeg 5.1 of H.264, MPEG-1, -2
/// and -4, and VP9.
LossyCoding coding_of_frame(const AVFrame& frame, const std::string& lossy_codec) {
  LossyCoding coding{.codec = lossy_codec};
  const AVFrameSideData* exported = av_frame_get_side_data(&frame, AV_FRAME_DATA_VIDEO_ENC_PARAMS);
  if (exported == nullptr) {
    return coding;
  }
  auto& parameters = *reinterpret_cast<AVVideoEncParams*>(exported->data);
  const int extra_bits = describe_pixel_format(frame.format).comp[0].depth - 8;
  coding.step_grey_levels =
      std::max(0.0, std::ldexp(step_of(parameters.type, mean_qp(parameters)), -extra_bits));
  coding.block_px = parameters.type == AV_VIDEO_ENC_PARAMS_MPEG2 ? 8 : 4;
  return coding;
}

}  // namespace

VideoPicture::VideoPicture(const AVFrame& frame, std::shared_ptr<PictureConverters> converters,
                           std::string name, std::string lossy_codec)
    : frame_(av_frame_clone(&frame)),
      converters_(std::move(converters)),
      name_(std::move(name)),
      lossy_codec_(std::move(lossy_codec)) {
  if (frame_ == nullptr) {
    throw std::bad_alloc();
  }
}

VideoPicture VideoPicture::share() const {
  return is_empty() ? VideoPicture() : VideoPicture(*frame_, converters_, name_, lossy_codec_);
}

std::size_t VideoPicture::bytes() const {
  std::size_t bytes = 0;
  for (int plane = 0; !is_empty() && plane < AV_NUM_DATA_POINTERS; ++plane) {
    bytes += frame_->buf[plane] == nullptr ? 0 : frame_->buf[plane]->size;
  }
  return bytes;
}

void VideoPicture::convert(Photograph& photograph) {
  const LibavFrame frame = std::move(frame_);
  const auto converter = converters_->borrow();
  photograph.origin = {};
  photograph.left_out = {};
  if (!lossy_codec_.empty()) {
    photograph.origin.coding = coding_of_frame(*frame, lossy_codec_);
  }
  try {
    converter->convert(*frame, photograph);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", name_, error.what()));
  }
}

}  // namespace vantage
