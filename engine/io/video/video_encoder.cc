#include "engine/io/video/video_encoder.h"

#include <fmt/format.h>

#include <memory>
#include <new>

#include "engine/io/video/grey_to_frame.h"
#include "engine/io/video/libav_functions.h"
#include "engine/io/video/photograph_to_frame.h"

extern "C" {
#include <libavcodec/avcodec.h>
}

namespace vantage {
namespace {

const char* encoder_name(VideoCoding coding) {
  switch (coding) {
    case VideoCoding::kFfv1_16:
    case VideoCoding::kFfv1_10:
      return "ffv1";
    case VideoCoding::kHevc_10:
      return "libx265";
    case VideoCoding::kProRes_10:
      return "prores_ks";
    case VideoCoding::kH264:
      break;
  }
  return "libx264";
}

/// Options of the encoders. All: one algorithm on every processor, one thread, and headers that do
/// not depend on the pictures, so that bytes depend on the frames only and segments can be joined.
///
/// The preset of x264: photographs of 1226×370 pixels at factor 18 take 23 ms a frame (Zen 4, one
/// thread) with "veryfast". "superfast" takes 14 ms and a tenth more bytes, "faster", "fast" and
/// "medium" take 35, 48 and 63 ms with no fewer bytes. No tuning: views are of any kind.
void add_options(const VideoEncoding& encoding, AVDictionary** options) {
  switch (encoding.coding) {
    case VideoCoding::kH264:
      av_dict_set(options, "preset", "veryfast", 0);
      av_dict_set_int(options, "crf", encoding.crf, 0);
      av_dict_set(options, "x264-params", "cpu-independent=1:stitchable=1", 0);
      return;
    case VideoCoding::kFfv1_16:
    case VideoCoding::kFfv1_10:
      av_dict_set(options, "level", "3", 0);
      av_dict_set(options, "coder", "range_def", 0);
      av_dict_set(options, "slicecrc", "1", 0);
      return;
    case VideoCoding::kHevc_10:
      av_dict_set(options, "preset", "fast", 0);
      av_dict_set_int(options, "crf", encoding.crf, 0);
      av_dict_set(options, "x265-params",
                  "log-level=none:pools=none:frame-threads=1:bframes=0:open-gop=0:info=0:"
                  "range=full",
                  0);
      return;
    case VideoCoding::kProRes_10:
      av_dict_set(options, "profile", "hq", 0);
      return;
  }
}

void describe_colours(const VideoEncoding& encoding, AVCodecContext& encoder) {
  if (is_grey(encoding.coding)) {
    encoder.color_range =
        encoding.coding == VideoCoding::kProRes_10 ? AVCOL_RANGE_MPEG : AVCOL_RANGE_JPEG;
    return;
  }
  encoder.color_range = AVCOL_RANGE_MPEG;
  encoder.colorspace = AVCOL_SPC_BT709;
  encoder.color_primaries = AVCOL_PRI_BT709;
  encoder.color_trc = AVCOL_TRC_BT709;
  encoder.chroma_sample_location = AVCHROMA_LOC_LEFT;
}

}  // namespace

EncoderSetup::EncoderSetup(const VideoEncoding& encoding, int width, int height)
    : name_(encoder_name(encoding.coding)), codec_(libav().avcodec_find_encoder_by_name(name_)) {
  if (codec_ == nullptr) {
    return;
  }
  encoder_.reset(libav().avcodec_alloc_context3(codec_));
  if (encoder_ == nullptr) {
    throw std::bad_alloc();
  }
  const auto side = [&](int px) {
    return takes_odd_sizes(encoding.coding) ? px : (px + 1) / 2 * 2;
  };
  const AVRational time_unit = {static_cast<int>(encoding.rate.denominator),
                                static_cast<int>(encoding.rate.numerator)};
  encoder_->width = side(width);
  encoder_->height = side(height);
  encoder_->pix_fmt = static_cast<AVPixelFormat>(pixel_format_of(encoding.coding));
  describe_colours(encoding, *encoder_);
  encoder_->time_base = time_unit;
  encoder_->framerate = {time_unit.den, time_unit.num};
  encoder_->thread_count = 1;
  encoder_->flags |=
      AV_CODEC_FLAG_GLOBAL_HEADER | AV_CODEC_FLAG_CLOSED_GOP | AV_CODEC_FLAG_BITEXACT;
  if (takes_odd_sizes(encoding.coding)) {
    encoder_->gop_size = 1;  // every frame can be decoded alone
  }
  add_options(encoding, &options_);
}

EncoderSetup::~EncoderSetup() { av_dict_free(&options_); }

LibavCodec EncoderSetup::open(int& result) {
  result = codec_ == nullptr ? AVERROR_ENCODER_NOT_FOUND
                             : libav().avcodec_open2(encoder_.get(), codec_, &options_);
  return result < 0 ? LibavCodec() : std::move(encoder_);
}

std::function<AVFrame&(const Photograph&)> make_frame_conversion(VideoCoding coding, int width,
                                                                 int height) {
  if (is_grey(coding)) {
    auto conversion = std::make_shared<GreyToFrame>(coding, width, height);
    return [conversion](const Photograph& frame) -> AVFrame& { return conversion->convert(frame); };
  }
  auto conversion = std::make_shared<PhotographToFrame>(width, height);
  return [conversion](const Photograph& frame) -> AVFrame& { return conversion->convert(frame); };
}

}  // namespace vantage
