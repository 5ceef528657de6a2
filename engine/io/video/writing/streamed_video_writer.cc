#include "engine/io/video/writing/streamed_video_writer.h"

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "engine/image/eight_bit.h"
#include "engine/io/video/libav_functions.h"
#include "engine/io/video/libav_scaler.h"

extern "C" {
#include <libavutil/frame.h>
#include <libavutil/imgutils.h>
#include <libavutil/pixdesc.h>
}

namespace vantage {
namespace {

void add(std::vector<std::uint8_t>& bytes, std::string_view text) {
  bytes.insert(bytes.end(), text.begin(), text.end());
}

}  // namespace

StreamedVideoWriter::StreamedVideoWriter(StreamOutput output, StreamFormat format, FrameRate rate,
                                         const FilmFormat& film)
    : output_(std::move(output)), format_(format), rate_(rate), film_(film) {}

void StreamedVideoWriter::add_header(const AVFrame& frame, bool is_grey) {
  const bool has_10_bits = describe_pixel_format(frame.format).comp[0].depth == 10;
  const std::string header = fmt::format(
      "YUV4MPEG2 W{} H{} F{}:{} Ip A{}:{} C{} XCOLORRANGE={}\n", frame.width, frame.height,
      rate_.numerator, rate_.denominator, film_.pixel_aspect.width, film_.pixel_aspect.height,
      is_grey       ? "mono16"
      : has_10_bits ? "420p10 XYSCSS=420P10"
                    : "420mpeg2",
      frame.color_range == AVCOL_RANGE_JPEG ? "FULL" : "LIMITED");
  add(bytes_, header);
  has_header_ = true;
}

void StreamedVideoWriter::add_planes(const AVFrame& frame) {
  const auto format = static_cast<AVPixelFormat>(frame.format);
  const std::size_t before = bytes_.size();
  const int size = libav().av_image_get_buffer_size(format, frame.width, frame.height, 1);
  bytes_.resize(before + static_cast<std::size_t>(size));
  libav().av_image_copy_to_buffer(bytes_.data() + before, size, frame.data, frame.linesize, format,
                                  frame.width, frame.height, 1);
}

void StreamedVideoWriter::add_rgb(const Photograph& frame) {
  const Image<std::uint8_t> image = eight_bit(frame);
  const std::size_t row_bytes = 3 * static_cast<std::size_t>(image.width());
  for (int y = 0; y < image.height(); ++y) {
    for (std::size_t i = 0; i < row_bytes; ++i) {
      bytes_.push_back(image.channels() == 3 ? image.row(y)[i] : image.row(y)[i / 3]);
    }
  }
}

void StreamedVideoWriter::write(const Photograph& frame) {
  const bool is_grey =
      std::holds_alternative<Image<std::uint16_t>>(frame.pixels) && frame.channels() == 1;
  bytes_.clear();
  if (format_ == StreamFormat::kRawVideo && !is_grey) {
    add_rgb(frame);
  } else {
    if (!convert_) {
      convert_ = make_frame_conversion(is_grey                  ? VideoCoding::kFfv1_16
                                       : film_.colours.bits > 8 ? VideoCoding::kHevcColours_10
                                                                : VideoCoding::kH264,
                                       frame.width(), frame.height(), film_.colours);
    }
    const LibavFrame converted = convert_(frame);
    if (format_ == StreamFormat::kY4m) {
      if (!has_header_) {
        add_header(*converted, is_grey);
      }
      add(bytes_, "FRAME\n");
    }
    add_planes(*converted);
  }
  output_.put(bytes_);
}

}  // namespace vantage
