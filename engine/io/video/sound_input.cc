#include "engine/io/video/sound_input.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/error.h"
#include "engine/io/video/libav_functions.h"

extern "C" {
#include <libavformat/avformat.h>
}

namespace vantage {
namespace {

/// Decoders need some packets before the first audible one, and seeking is not exact.
constexpr double kRunUpSeconds = 1;

double start_seconds(const AVStream* stream) {
  return stream == nullptr || stream->start_time == AV_NOPTS_VALUE
             ? 0
             : static_cast<double>(stream->start_time) * av_q2d(stream->time_base);
}

}  // namespace

SoundInput::SoundInput(const SoundTrack& track)
    : name_(track.video.string()),
      length_seconds_(track.end_seconds - track.begin_seconds),
      input_(open_media_file(track.video)),
      stream_(find_sound_stream(*input_)) {
  begin_seconds_ = track.begin_seconds + start_seconds(find_video_stream(*input_));
  if (stream_ == nullptr) {
    return;
  }
  read_only(*input_, *stream_);
  const double run_up = begin_seconds_ - kRunUpSeconds;
  if (run_up > start_seconds(stream_)) {
    // If seeking fails the file is read from its start.
    libav().av_seek_frame(input_.get(), stream_->index,
                          std::llround(run_up / av_q2d(stream_->time_base)), AVSEEK_FLAG_BACKWARD);
  }
}

bool SoundInput::read(AVPacket& packet) {
  for (;;) {
    const int result = libav().av_read_frame(input_.get(), &packet);
    if (result == AVERROR_EOF) {
      return false;
    }
    if (result >= 0 && (packet.flags & AV_PKT_FLAG_CORRUPT) != 0 &&
        libav().avio_feof(input_->pb) != 0) {
      libav().av_packet_unref(&packet);
      return false;
    }
    if (result < 0) {
      fail(libav_message(result));
    }
    if (packet.pts == AV_NOPTS_VALUE) {
      packet.pts = packet.dts;
    }
    if (packet.stream_index == stream_->index && packet.size > 0 && packet.pts != AV_NOPTS_VALUE) {
      if (seconds(packet.pts) < length_seconds_) {
        return true;
      }
      libav().av_packet_unref(&packet);
      return false;
    }
    libav().av_packet_unref(&packet);
  }
}

double SoundInput::seconds(long long time) const {
  return static_cast<double>(time) * av_q2d(stream_->time_base) - begin_seconds_;
}

long long SoundInput::start_time() const {
  return std::llround(begin_seconds_ / av_q2d(stream_->time_base));
}

void SoundInput::fail(const std::string& problem) const {
  throw Error(fmt::format("{}: its sound cannot be read ({})", name_, problem));
}

}  // namespace vantage
