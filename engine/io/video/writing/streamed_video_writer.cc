#include "engine/io/video/writing/streamed_video_writer.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <variant>

#include "engine/error.h"
#include "engine/image/eight_bit.h"
#include "engine/io/video/libav_scaler.h"

extern "C" {
#include <libavutil/frame.h>
#include <libavutil/imgutils.h>
#include <libavutil/pixdesc.h>
}

namespace vantage {

StreamedVideoWriter::StreamedVideoWriter(std::FILE* stream, StreamFormat format, FrameRate rate,
                                         const FilmFormat& film)
    : stream_(stream), format_(format), rate_(rate), film_(film) {}

void StreamedVideoWriter::put(const void* bytes, std::size_t count) {
  if (std::fwrite(bytes, 1, count, stream_) != count) {
    throw Error(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
  }
}

void StreamedVideoWriter::put_header(const AVFrame& frame, bool is_grey) {
  const bool has_10_bits = describe_pixel_format(frame.format).comp[0].depth == 10;
  const std::string header = fmt::format(
      "YUV4MPEG2 W{} H{} F{}:{} Ip A{}:{} C{} XCOLORRANGE={}\n", frame.width, frame.height,
      rate_.numerator, rate_.denominator, film_.pixel_aspect.width, film_.pixel_aspect.height,
      is_grey       ? "mono16"
      : has_10_bits ? "420p10 XYSCSS=420P10"
                    : "420mpeg2",
      frame.color_range == AVCOL_RANGE_JPEG ? "FULL" : "LIMITED");
  put(header.data(), header.size());
  has_header_ = true;
}

void StreamedVideoWriter::put_planes(const AVFrame& frame) {
  const auto format = static_cast<AVPixelFormat>(frame.format);
  planes_.resize(
      static_cast<std::size_t>(av_image_get_buffer_size(format, frame.width, frame.height, 1)));
  av_image_copy_to_buffer(planes_.data(), static_cast<int>(planes_.size()), frame.data,
                          frame.linesize, format, frame.width, frame.height, 1);
  put(planes_.data(), planes_.size());
}

void StreamedVideoWriter::put_rgb(const Photograph& frame) {
  const Image<std::uint8_t> image = eight_bit(frame);
  std::vector<std::uint8_t> row(3 * static_cast<std::size_t>(image.width()));
  for (int y = 0; y < image.height(); ++y) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      row[i] = image.channels() == 3 ? image.row(y)[i] : image.row(y)[i / 3];
    }
    put(row.data(), row.size());
  }
}

void StreamedVideoWriter::write(const Photograph& frame) {
  const bool is_grey =
      std::holds_alternative<Image<std::uint16_t>>(frame.pixels) && frame.channels() == 1;
  if (format_ == StreamFormat::kRawVideo && !is_grey) {
    put_rgb(frame);
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
        put_header(*converted, is_grey);
      }
      put("FRAME\n", 6);
    }
    put_planes(*converted);
  }
  if (std::fflush(stream_) != 0) {
    throw Error(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
  }
}

}  // namespace vantage
