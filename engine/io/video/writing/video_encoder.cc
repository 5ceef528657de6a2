#include "engine/io/video/writing/video_encoder.h"

#include <new>
#include <string>
#include <utility>

#include "engine/io/video/libav_functions.h"
#include "engine/io/video/stated_format.h"

extern "C" {
#include <libavcodec/avcodec.h>
}

namespace vantage {
namespace {

constexpr const char* kX265 = "x265-params";

}  // namespace

EncoderSetup::EncoderSetup(const VideoEncoding& encoding, int width, int height)
    : name_(traits_of(encoding.coding).encoder),
      codec_(libav().avcodec_find_encoder_by_name(name_)) {
  if (codec_ == nullptr) {
    return;
  }
  encoder_.reset(libav().avcodec_alloc_context3(codec_));
  if (encoder_ == nullptr) {
    throw std::bad_alloc();
  }
  const VideoCodingTraits& coding = traits_of(encoding.coding);
  const auto side = [&](int px) { return coding.has_odd_sizes ? px : (px + 1) / 2 * 2; };
  const AVRational time_unit = {static_cast<int>(encoding.rate.denominator),
                                static_cast<int>(encoding.rate.numerator)};
  encoder_->width = side(width);
  encoder_->height = side(height);
  encoder_->pix_fmt = static_cast<AVPixelFormat>(coding.pixel_format);
  if (const PixelAspect aspect = encoding.format.pixel_aspect; aspect != PixelAspect()) {
    encoder_->sample_aspect_ratio = {aspect.width, aspect.height};
  }
  encoder_->color_range = coding.has_full_range ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG;
  const FilmColours colours = written_colours(encoding.format.colours, encoding.coding);
  if (!is_grey(encoding.coding)) {
    encoder_->color_range = colours.has_full_range ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG;
    encoder_->colorspace = static_cast<AVColorSpace>(colours.matrix);
    encoder_->color_primaries = static_cast<AVColorPrimaries>(colours.primaries);
    encoder_->color_trc = static_cast<AVColorTransferCharacteristic>(colours.transfer);
    encoder_->chroma_sample_location = AVCHROMA_LOC_LEFT;
  }
  encoder_->time_base = time_unit;
  encoder_->framerate = {time_unit.den, time_unit.num};
  encoder_->thread_count = 1;
  encoder_->flags |=
      AV_CODEC_FLAG_GLOBAL_HEADER | AV_CODEC_FLAG_CLOSED_GOP | AV_CODEC_FLAG_BITEXACT;
  if (coding.has_odd_sizes) {
    encoder_->gop_size = 1;  // every frame can be decoded alone
  }
  libav().av_dict_parse_string(&options_, coding.options, "=", ",", 0);
  if (encoding.coding == VideoCoding::kHevcColours_10 && colours.is_hdr()) {
    std::string hdr = std::string(libav().av_dict_get(options_, kX265, nullptr, 0)->value);
    hdr += colours.mastering_display.empty() ? "" : ":master-display=" + colours.mastering_display;
    hdr += colours.light_level.empty() ? "" : ":max-cll=" + colours.light_level;
    libav().av_dict_set(&options_, kX265, hdr.c_str(), 0);
  }
  if (coding.has_crf) {
    libav().av_dict_set_int(&options_, "crf", encoding.crf, 0);
  }
}

EncoderSetup::~EncoderSetup() { libav().av_dict_free(&options_); }

LibavCodec EncoderSetup::open(int& result) {
  result = codec_ == nullptr ? AVERROR_ENCODER_NOT_FOUND
                             : libav().avcodec_open2(encoder_.get(), codec_, &options_);
  return result < 0 ? LibavCodec() : std::move(encoder_);
}

}  // namespace vantage
