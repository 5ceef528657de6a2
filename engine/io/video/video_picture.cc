#include "engine/io/video/video_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "engine/error.h"
#include "engine/image/stereo_packing.h"
#include "engine/io/video/libav_filter.h"
#include "engine/io/video/libav_functions.h"
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
  const AVFrameSideData* exported =
      libav().av_frame_get_side_data(&frame, AV_FRAME_DATA_VIDEO_ENC_PARAMS);
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

/// `frame` with the lines of its second field interpolated, in space and from its neighbours, which
/// may be null. Each picture has a chain of its own, so it is the same wherever decoding began.
LibavFrame deinterlaced(const AVFrame* before, const AVFrame& frame, const AVFrame* after,
                        bool only_if_flagged) {
  LibavFilter filter(only_if_flagged ? "bwdif=mode=send_frame:deint=interlaced"
                                     : "bwdif=mode=send_frame:deint=all",
                     frame);
  const auto fits = [&](const AVFrame* other) {
    return other != nullptr && other->width == frame.width && other->height == frame.height &&
           other->format == frame.format;
  };
  const bool has_before = fits(before);
  if (has_before) {
    filter.put(*before);
  }
  filter.put(frame);
  if (fits(after)) {
    filter.put(*after);
  }
  filter.end();
  LibavFrame result = filter.take();
  if (has_before) {
    result = filter.take();
  }
  if (result == nullptr) {
    throw Error("it cannot be deinterlaced");
  }
  return result;
}

/// Every second line of an interlaced frame.
LibavFrame field_of(const AVFrame& frame, int number) {
  LibavFrame field = another_reference(frame);
  for (int plane = 0; plane < AV_NUM_DATA_POINTERS && field->data[plane] != nullptr; ++plane) {
    field->data[plane] += number * std::ptrdiff_t{field->linesize[plane]};
    field->linesize[plane] *= 2;
  }
  if (field->colorspace == AVCOL_SPC_UNSPECIFIED) {
    // By the height of the whole frame, see FrameToPhotograph.
    field->colorspace = frame.height < 720 ? AVCOL_SPC_SMPTE170M : AVCOL_SPC_BT709;
  }
  field->height /= 2;
  return field;
}

}  // namespace

VideoPicture::VideoPicture(const AVFrame& frame, std::shared_ptr<PictureConverters> converters,
                           std::string name, PictureHandling handling)
    : frame_(another_reference(frame)),
      converters_(std::move(converters)),
      name_(std::move(name)),
      handling_(std::move(handling)) {}

VideoPicture VideoPicture::share() const {
  if (is_empty()) {
    return {};
  }
  VideoPicture shared(*frame_, converters_, name_, handling_);
  shared.before_ = before_ == nullptr ? nullptr : another_reference(*before_);
  shared.after_ = after_ == nullptr ? nullptr : another_reference(*after_);
  return shared;
}

void VideoPicture::set_neighbours(const VideoPicture& before, const VideoPicture& after) {
  before_ = before.is_empty() ? nullptr : another_reference(*before.frame_);
  after_ = after.is_empty() ? nullptr : another_reference(*after.frame_);
}

std::size_t VideoPicture::bytes() const { return is_empty() ? 0 : bytes_of(*frame_); }

bool VideoPicture::convert(Photograph& photograph, const PictureHalves& halves) {
  using Deinterlacing = PictureHandling::Deinterlacing;
  LibavFrame frame = std::move(frame_);
  const auto converter = converters_->borrow();
  bool is_halved = false;
  PhotographOrigin origin;
  if (!handling_.lossy_codec.empty()) {
    origin.coding = coding_of_frame(*frame, handling_.lossy_codec);
  }
  for (Photograph* const made : {&photograph, halves[0], halves[1]}) {
    if (made != nullptr) {
      made->origin = origin;
      made->left_out = {};
    }
  }
  try {
    if (handling_.deinterlacing != Deinterlacing::kNone) {
      frame = deinterlaced(before_.get(), *frame, after_.get(),
                           handling_.deinterlacing == Deinterlacing::kFlaggedFrames);
    }
    const bool has_fields =
        handling_.takes_fields_apart && frame->interlaced_frame != 0 && frame->height % 4 == 0;
    is_halved = halves != PictureHalves{} && !has_fields &&
                handling_.turn == Orientation::kAsStored &&
                converter->convert_halves(*frame, halves);
    if (has_fields) {
      Photograph upper;
      Photograph lower;
      converter->convert(*field_of(*frame, 0), upper);
      converter->convert(*field_of(*frame, 1), lower);
      pack_stereo(upper, lower, {.layout = StereoLayout::kRows}, photograph);
    } else if (!is_halved) {
      converter->convert(*frame, photograph);
    }
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", name_, error.what()));
  }
  before_.reset();
  after_.reset();
  if (!is_halved) {
    turn_upright(photograph, handling_.turn);
  }
  return is_halved;
}

}  // namespace vantage
