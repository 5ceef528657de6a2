#include "engine/io/video/raw_video.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <new>
#include <utility>

#include "engine/error.h"
#include "engine/image/eight_bit.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/video/libav_functions.h"
#include "scheduler/interruption.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/imgutils.h>
#include <libavutil/pixdesc.h>
}

namespace vantage {
namespace {

constexpr const char* kStandardInput = "standard input";

LibavInput open_stream(const StandardInput& bytes, const std::optional<RawVideoShape>& raw,
                       FrameRate raw_rate) {
  silence_libav();
  const AVInputFormat* format = libav().av_find_input_format(raw ? "rawvideo" : "yuv4mpegpipe");
  AVDictionary* options = nullptr;
  if (raw) {
    if (av_get_pix_fmt(raw->pixel_format.c_str()) == AV_PIX_FMT_NONE) {
      throw UsageError(
          fmt::format("raw-video has the pixel format '{}', expected one of FFmpeg's "
                      "such as rgb24, gray, yuv420p",
                      raw->pixel_format));
    }
    av_dict_set(&options, "video_size", fmt::format("{}x{}", raw->width_px, raw->height_px).c_str(),
                0);
    av_dict_set(&options, "pixel_format", raw->pixel_format.c_str(), 0);
    av_dict_set(&options, "framerate", to_string(raw_rate).c_str(), 0);
  }
  AVFormatContext* opened = libav().avformat_alloc_context();
  if (opened == nullptr) {
    av_dict_free(&options);
    throw std::bad_alloc();
  }
  opened->pb = bytes.io();
  int result = libav().avformat_open_input(&opened, "", format, &options);
  av_dict_free(&options);
  LibavInput input(result < 0 ? nullptr : opened);
  if (result >= 0) {
    result = libav().avformat_find_stream_info(input.get(), nullptr);
  }
  if (bytes.is_stopped()) {
    throw scheduler::Interrupted();
  }
  if (result < 0 || input->nb_streams == 0) {
    throw Error(fmt::format("{}: is empty or no {} video", kStandardInput, raw ? "raw" : "y4m"));
  }
  return input;
}

}  // namespace

StreamedVideo::StreamedVideo(const std::optional<RawVideoShape>& raw, FrameRate raw_rate,
                             const std::atomic<bool>* stop)
    : bytes_(std::make_unique<StandardInput>(stop)),
      input_(open_stream(*bytes_, raw, raw_rate)),
      stream_(input_->streams[0]),
      packet_(make_libav_packet()),
      frame_(make_libav_frame()) {
  const AVCodecParameters& parameters = *stream_->codecpar;
  FileBytes({}, kStandardInput).check_dimensions(parameters.width, parameters.height);
  const AVCodec* decoder = libav().avcodec_find_decoder(parameters.codec_id);
  codec_.reset(decoder == nullptr ? nullptr : libav().avcodec_alloc_context3(decoder));
  if (codec_ == nullptr || libav().avcodec_parameters_to_context(codec_.get(), &parameters) < 0 ||
      libav().avcodec_open2(codec_.get(), decoder, nullptr) < 0) {
    throw Error(fmt::format("{}: its video cannot be decoded", kStandardInput));
  }
  const AVRational rate =
      stream_->avg_frame_rate.num > 0 ? stream_->avg_frame_rate : stream_->r_frame_rate;
  rate_ = parse_frame_rate(fmt::format("{}/{}", rate.num, rate.den)).value_or(FrameRate());
  if (!decode_next(first_)) {
    if (bytes_->is_stopped()) {
      throw scheduler::Interrupted();
    }
    throw Error(fmt::format("{}: is empty, expected a video", kStandardInput));
  }
}

void StreamedVideo::fail_cut() {
  ended_ = true;
  throw Error(fmt::format("{}: the stream ends inside it or is damaged", describe(decoded_)));
}

bool StreamedVideo::decode_next(VideoPicture& picture) {
  if (ended_) {
    return false;
  }
  int result = libav().av_read_frame(input_.get(), packet_.get());
  if (result == AVERROR_EOF) {
    // The reader of y4m takes a part of a frame for the end, too.
    const AVIOContext& io = *input_->pb;
    if (frames_end_ >= 0 && io.pos - (io.buf_end - io.buf_ptr) > frames_end_) {
      fail_cut();
    }
    ended_ = true;
    return false;
  }
  frames_end_ = packet_->pos >= 0 ? packet_->pos + packet_->size : -1;
  const bool is_whole = result >= 0 && (packet_->flags & AV_PKT_FLAG_CORRUPT) == 0;
  if (!is_whole && bytes_->is_stopped()) {
    libav().av_packet_unref(packet_.get());
    ended_ = true;
    return false;
  }
  if (is_whole) {
    result = libav().avcodec_send_packet(codec_.get(), packet_.get());
    if (result >= 0) {
      result = libav().avcodec_receive_frame(codec_.get(), frame_.get());
    }
  }
  libav().av_packet_unref(packet_.get());
  if (!is_whole || result < 0) {
    fail_cut();
  }
  picture = VideoPicture(*frame_, converters_, describe(decoded_));
  ++decoded_;
  return true;
}

bool StreamedVideo::fetch(FetchedFrame& frame) {
  frame.file.clear();
  frame.picture = std::move(first_);
  frame.frames_missing = 0;
  frame.remarks.clear();
  return !frame.picture.is_empty() || decode_next(frame.picture);
}

void StreamedVideo::skip_to(int index) {
  const int next = decoded_ - (first_.is_empty() ? 0 : 1);
  if (index < next) {
    throw Error(fmt::format("{}: is over, expected frames in order", describe(index)));
  }
  if (index > next) {
    first_ = {};
  }
  VideoPicture dropped;
  while (decoded_ < index && decode_next(dropped)) {
  }
}

std::string StreamedVideo::describe(int index) const {
  return fmt::format("{} frame {}", kStandardInput, index);
}

StreamedVideoWriter::StreamedVideoWriter(std::FILE* stream, StreamFormat format, FrameRate rate)
    : stream_(stream), format_(format), rate_(rate) {}

void StreamedVideoWriter::put(const void* bytes, std::size_t count) {
  if (std::fwrite(bytes, 1, count, stream_) != count) {
    throw Error(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
  }
}

void StreamedVideoWriter::put_header(const AVFrame& frame, bool is_grey) {
  const std::string header = fmt::format(
      "YUV4MPEG2 W{} H{} F{}:{} Ip A1:1 C{}\n", frame.width, frame.height, rate_.numerator,
      rate_.denominator, is_grey ? "mono16 XCOLORRANGE=FULL" : "420mpeg2 XCOLORRANGE=LIMITED");
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
      convert_ = make_frame_conversion(is_grey ? VideoCoding::kFfv1_16 : VideoCoding::kH264,
                                       frame.width(), frame.height());
    }
    const AVFrame& converted = convert_(frame);
    if (format_ == StreamFormat::kY4m) {
      if (!has_header_) {
        put_header(converted, is_grey);
      }
      put("FRAME\n", 6);
    }
    put_planes(converted);
  }
  if (std::fflush(stream_) != 0) {
    throw Error(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
  }
}

}  // namespace vantage
