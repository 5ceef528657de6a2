#include "engine/io/video/video_decoder.h"

#include <fmt/format.h>

#include <limits>
#include <new>

#include "engine/error.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/video/libav_functions.h"
#include "scheduler/trace.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

namespace vantage {
namespace {

/// Decoders tested on damaged videos with frame threading. Not all are robust: FFmpeg 5.1's MPEG-4
/// part 2 decoder aborts the process.
bool can_decode_frames_at_once(AVCodecID codec) {
  switch (codec) {
    case AV_CODEC_ID_H264:
    case AV_CODEC_ID_HEVC:
    case AV_CODEC_ID_VP8:
    case AV_CODEC_ID_VP9:
    case AV_CODEC_ID_AV1:
    case AV_CODEC_ID_PRORES:
    case AV_CODEC_ID_FFV1:
    case AV_CODEC_ID_FFVHUFF:
    case AV_CODEC_ID_MJPEG:
      return true;
    default:
      return false;
  }
}

}  // namespace

LibavCodec open_decoder(const AVStream& stream, int threads, const std::string& name) {
  const AVCodec* decoder = libav().avcodec_find_decoder(stream.codecpar->codec_id);
  if (decoder == nullptr) {
    throw Error(fmt::format("{}: its codec {} is not supported", name,
                            libav().avcodec_get_name(stream.codecpar->codec_id)));
  }
  if (!is_for_footage(*decoder)) {
    throw Error(fmt::format("{}: its codec {} is none that footage uses, which alone are read",
                            name, libav().avcodec_get_name(stream.codecpar->codec_id)));
  }
  LibavCodec codec(libav().avcodec_alloc_context3(decoder));
  if (codec == nullptr) {
    throw std::bad_alloc();
  }
  int result = libav().avcodec_parameters_to_context(codec.get(), stream.codecpar);
  codec->pkt_timebase = stream.time_base;
  codec->thread_count = threads;
  codec->thread_type =
      FF_THREAD_SLICE | (can_decode_frames_at_once(decoder->id) ? FF_THREAD_FRAME : 0);
  codec->err_recognition = AV_EF_EXPLODE;
  codec->export_side_data = AV_CODEC_EXPORT_DATA_VIDEO_ENC_PARAMS;  // of VideoPicture
  codec->max_pixels = max_image_pixels();
  if (result >= 0) {
    result = libav().avcodec_open2(codec.get(), decoder, nullptr);
  }
  if (result < 0) {
    throw Error(fmt::format("{}: its {} video cannot be decoded ({})", name, decoder->name,
                            libav_message(result)));
  }
  return codec;
}

std::string name_of_lossy_codec(const AVStream& stream) {
  const AVCodecDescriptor* codec = libav().avcodec_descriptor_get(stream.codecpar->codec_id);
  return codec != nullptr && (codec->props & AV_CODEC_PROP_LOSSY) != 0 ? codec->name : "";
}

VideoDecoder::VideoDecoder(const std::filesystem::path& path, int threads, int track)
    : threads_(threads), input_(open_media_file(path)), stream_(find_video_stream(*input_, track)) {
  if (stream_ == nullptr && track != kMainVideo) {
    const std::size_t tracks = video_streams(*input_).size();
    throw Error(fmt::format("{}: has {} video track{}, expected #0 to #{}", path.string(), tracks,
                            tracks == 1 ? "" : "s", tracks == 0 ? 0 : tracks - 1));
  }
  if (stream_ == nullptr) {
    throw Error(fmt::format("{}: holds no video", path.string()));
  }
  const AVCodecParameters& parameters = *stream_->codecpar;
  if (parameters.width == 0 || parameters.height == 0) {
    throw Error(fmt::format(
        "{}: no frame of its video can be decoded (damaged, or cut without re-encoding)",
        path.string()));
  }
  FileBytes({}, path.string()).check_dimensions(parameters.width, parameters.height);
  read_only(*input_, *stream_);
  cut_.emplace(parameters);
  read_packet();
  if (cut_->misses_frames()) {
    threads_ = 1;  // only then are frames with inexcusable damage marked
  }
  codec_ = open_decoder(*stream_, threads_, path.string());
}

int VideoDecoder::read_from_file(AVPacket& packet) {
  int result = 0;
  do {
    libav().av_packet_unref(&packet);
    result = fetch_packet(*input_, packet);
  } while (result >= 0 && packet.stream_index != stream_->index);
  return result;
}

void VideoDecoder::read_packet() {
  if (!ahead_.empty()) {
    packet_ = std::move(ahead_.front());
    ahead_.pop_front();
  } else {
    read_result_ = read_from_file(*packet_);
  }
  packet_is_cut_off_ = read_result_ >= 0 && cut_->is_cut_off(*packet_);
}

std::string VideoDecoder::change_of_size(const AVPacket& packet) const {
  const LibavCodec codec = open_decoder(*stream_, 1, "");
  const LibavFrame frame = make_libav_frame();
  libav().avcodec_send_packet(codec.get(), &packet);
  libav().avcodec_send_packet(codec.get(), nullptr);
  const AVCodecParameters& before = *stream_->codecpar;
  if (libav().avcodec_receive_frame(codec.get(), frame.get()) < 0 ||
      (frame->width == before.width && frame->height == before.height)) {
    return {};
  }
  return fmt::format("the size of the pictures changes there, from {}x{} to {}x{}", before.width,
                     before.height, frame->width, frame->height);
}

bool VideoDecoder::is_before_another_size() {
  constexpr std::size_t kMaxAhead = 32;
  while (read_result_ >= 0 && ahead_.size() < kMaxAhead) {
    LibavPacket packet = make_libav_packet();
    if (read_from_file(*packet) < 0) {
      break;
    }
    ahead_.push_back(std::move(packet));
    if ((ahead_.back()->flags & AV_PKT_FLAG_KEY) != 0) {
      break;
    }
  }
  return !ahead_.empty() && !change_of_size(*ahead_.back()).empty();
}

bool VideoDecoder::start_at(const PossibleStart& start) {
  if (cut_->misses_frames()) {
    return false;
  }
  // Some containers seek by presentation time, which is later by the reordering delay of the
  // packets.
  std::int64_t lag = 0;
  for (int tries = 0; tries < 3; ++tries) {
    if (libav().av_seek_frame(input_.get(), stream_->index, start.time + tries * lag,
                              AVSEEK_FLAG_BACKWARD) < 0) {
      return false;
    }
    read_packet();
    if (read_result_ < 0 || packet_->pts == AV_NOPTS_VALUE || packet_->dts > start.time) {
      return false;
    }
    if (packet_->dts == start.time && packet_->pos == start.position) {
      return (packet_->flags & AV_PKT_FLAG_CORRUPT) == 0 &&
             begins_afresh(*packet_, *stream_->codecpar);
    }
    lag = packet_->pts - packet_->dts;
  }
  return false;
}

VideoDecoder::Step VideoDecoder::next() {
  // With frame threading this thread sends packets and waits for frames.
  const scheduler::Span span("decode video", codec_->active_thread_type == FF_THREAD_FRAME
                                                 ? scheduler::SpanKind::kWait
                                                 : scheduler::SpanKind::kWork);
  for (;;) {
    const int result = libav().avcodec_receive_frame(codec_.get(), frame_.get());
    if (result >= 0) {
      return check_frame();
    }
    if (result == AVERROR(EAGAIN)) {
      feed();
    } else if (result == AVERROR_EOF) {
      return problem_.empty() ? Step::kEnd : Step::kDamaged;
    } else if (!stop_feeding(libav_message(result), packet_time_, FoundBy::kDecoder)) {
      return Step::kDamaged;
    }
  }
}

VideoDecoder::Step VideoDecoder::check_frame() {
  const bool incomplete =
      frame_->decode_error_flags != 0 || (frame_->flags & AV_FRAME_FLAG_CORRUPT) != 0;
  if (incomplete) {
    problem_ = problem_.empty() ? "the frame is incomplete" : problem_;
    gave_all_before_damage_ = gave_all_before_damage_ && threads_ == 1;
    return Step::kDamaged;
  }
  const bool after_damage = !problem_.empty() && frame_->best_effort_timestamp >= damaged_time_;
  return after_damage ? Step::kDamaged : Step::kFrame;
}

void VideoDecoder::feed() {
  if (read_result_ == AVERROR_EOF) {
    libav().avcodec_send_packet(codec_.get(), nullptr);
    return;
  }
  if (read_result_ < 0) {
    stop_feeding(libav_message(read_result_), std::numeric_limits<std::int64_t>::max(),
                 FoundBy::kFile);
    return;
  }
  if (!packet_is_cut_off_) {
    packet_time_ = packet_->pts != AV_NOPTS_VALUE ? packet_->pts : packet_->dts;
    codec_->err_recognition = cut_->misses_frames() ? 0 : AV_EF_EXPLODE;
    const bool is_corrupt = (packet_->flags & AV_PKT_FLAG_CORRUPT) != 0;
    is_spliced_ = is_spliced_ || (is_corrupt && is_before_another_size());
    const bool is_key = (packet_->flags & AV_PKT_FLAG_KEY) != 0;
    if (const std::string change = is_spliced_ && is_key ? change_of_size(*packet_) : "";
        !change.empty()) {
      stop_feeding(change, std::numeric_limits<std::int64_t>::max(), FoundBy::kFile);
    } else if (is_corrupt && !is_spliced_) {
      const bool at_end = libav().avio_feof(input_->pb) != 0;
      stop_feeding(at_end ? "the file ends inside it" : "the file is damaged there", packet_time_,
                   FoundBy::kFile);
    } else if (const int sent = libav().avcodec_send_packet(codec_.get(), packet_.get());
               sent < 0) {
      stop_feeding(libav_message(sent), packet_time_, FoundBy::kDecoder);
    }
  }
  read_packet();
}

bool VideoDecoder::stop_feeding(const std::string& problem, std::int64_t damaged_time,
                                FoundBy found_by) {
  // With several threads, damage found by the decoder may be in any of the packets in flight.
  const bool is_exact =
      threads_ == 1 || (found_by == FoundBy::kFile && damaged_time != AV_NOPTS_VALUE);
  gave_all_before_damage_ = gave_all_before_damage_ && is_exact;
  if (!problem_.empty()) {
    return false;
  }
  problem_ = problem;
  damaged_time_ = is_exact ? damaged_time : AV_NOPTS_VALUE;
  libav().avcodec_send_packet(codec_.get(), nullptr);
  return true;
}

}  // namespace vantage
