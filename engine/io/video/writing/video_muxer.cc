#include "engine/io/video/writing/video_muxer.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>

#include "engine/error.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/video/libav_functions.h"
#include "engine/io/video/video_io.h"
#include "engine/io/video/video_structure.h"

extern "C" {
#include <libavformat/avformat.h>
}

namespace vantage {

void VideoMuxer::Free::operator()(AVFormatContext* output) const noexcept {
  libav().avio_closep(&output->pb);
  libav().avformat_free_context(output);
}

VideoMuxer::VideoMuxer(const std::filesystem::path& path)
    : path_(path), is_matroska_(lower_case_extension(path) == ".mkv"), file_(path) {
  silence_libav();
  const std::string address = "file:" + file_.temporary_path().string();
  AVFormatContext* output = nullptr;
  const char* container = is_matroska_                           ? "matroska"
                          : lower_case_extension(path) == ".mov" ? "mov"
                                                                 : "mp4";
  if (libav().avformat_alloc_output_context2(&output, nullptr, container, address.c_str()) < 0) {
    throw std::bad_alloc();
  }
  output_.reset(output);
  output_->flags |= AVFMT_FLAG_BITEXACT;
  if (const int result = libav().avio_open(&output_->pb, address.c_str(), AVIO_FLAG_WRITE);
      result < 0) {
    fail(libav_message(result));
  }
}

VideoMuxer::~VideoMuxer() = default;

void VideoMuxer::fail(const std::string& problem) const {
  throw Error(fmt::format("cannot write {}: {}", path_.string(), problem));
}

int VideoMuxer::add_stream(const AVCodecParameters& parameters, AVRational time_unit,
                           bool is_steady) {
  AVStream* stream = libav().avformat_new_stream(output_.get(), nullptr);
  if (stream == nullptr || libav().avcodec_parameters_copy(stream->codecpar, &parameters) < 0) {
    throw std::bad_alloc();
  }
  stream->codecpar->codec_tag = 0;  // another container's tag may be meaningless here
  stream->sample_aspect_ratio = parameters.sample_aspect_ratio;
  stream->time_base = time_unit;
  if (is_matroska_ && output_->nb_streams == 1 && is_steady) {
    // Times are rounded to milliseconds there, so the duration of a frame is stored, too.
    stream->avg_frame_rate = {time_unit.den, time_unit.num};
  }
  return stream->index;
}

void VideoMuxer::begin() {
  AVDictionary* options = nullptr;
  if (!is_matroska_) {
    libav().av_dict_set(&options, "movflags", "+faststart", 0);
  }
  const int result = libav().avformat_write_header(output_.get(), &options);
  libav().av_dict_free(&options);
  if (result < 0) {
    fail(libav_message(result));
  }
}

void VideoMuxer::write(AVPacket& packet, int stream, AVRational time_unit) {
  if (is_matroska_ && stream > 0 && packet.pts < 0) {
    // Start-up of a sound decoder. Matroska has no times before 0: it would shift the video.
    libav().av_packet_unref(&packet);
    return;
  }
  packet.stream_index = stream;
  packet.pos = -1;
  libav().av_packet_rescale_ts(&packet, time_unit, output_->streams[stream]->time_base);
  if (is_matroska_ && stream == 0) {
    // Times less than a millisecond apart must stay different.
    packet.pts = std::max(packet.pts, last_time_ + 1);
    packet.dts = packet.pts;  // no coding in this container decodes ahead
    last_time_ = packet.pts;
  }
  int result = libav().av_interleaved_write_frame(output_.get(), &packet);
  if (result >= 0) {
    result = output_->pb->error;
  }
  if (result < 0) {
    fail(libav_message(result));
  }
}

void VideoMuxer::rename(const std::filesystem::path& path) {
  path_ = path;
  file_.rename(path);
}

void VideoMuxer::finish(int frames) {
  int result = libav().av_write_trailer(output_.get());
  const int closed = libav().avio_closep(&output_->pb);
  if (result >= 0) {
    result = closed;
  }
  output_.reset();
  if (result < 0) {
    fail(libav_message(result));
  }
  int stored = 0;
  try {
    check_video_is_whole(file_.temporary_path());
    stored = VideoReader(file_.temporary_path()).frame_count();
  } catch (const Error&) {
    stored = 0;
  }
  if (stored != frames) {
    fail(fmt::format("{} of {} frames were stored (disk full?)", stored, frames));
  }
  file_.commit();
}

}  // namespace vantage
