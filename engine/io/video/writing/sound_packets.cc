#include "engine/io/video/writing/sound_packets.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

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

class CopiedSound : public SoundPackets {
 public:
  explicit CopiedSound(SoundInput input) : input_(std::move(input)) {}

  [[nodiscard]] const AVCodecParameters& parameters() const override {
    return *input_.stream()->codecpar;
  }
  [[nodiscard]] AVRational time_unit() const override { return input_.stream()->time_base; }

  bool next() override {
    AVPacket& packet = this->packet();
    while (input_.read(packet)) {
      // One packet more than is audible: the decoder needs its state for the first one.
      if (input_.seconds(packet.pts + 2 * packet.duration) > 0) {
        packet.pts -= input_.start_time();
        packet.dts = packet.pts;
        return true;
      }
      libav().av_packet_unref(&packet);
    }
    return false;
  }

 private:
  SoundInput input_;
};

bool is_copied(AVCodecID codec) {
  switch (codec) {
    case AV_CODEC_ID_AAC:
    case AV_CODEC_ID_MP3:
    case AV_CODEC_ID_AC3:
    case AV_CODEC_ID_EAC3:
    case AV_CODEC_ID_OPUS:
    case AV_CODEC_ID_ALAC:
      return true;
    default:
      return false;
  }
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
    const int result = fetch_packet(*input_, packet);
    if (result == AVERROR_EOF) {
      return false;
    }
    if (result >= 0 && (packet.flags & AV_PKT_FLAG_CORRUPT) != 0 &&
        libav().avio_feof(input_->pb) != 0 && read_error(*input_) == 0) {
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

double SoundPackets::seconds() const {
  return static_cast<double>(packet_->pts) * av_q2d(time_unit());
}

std::unique_ptr<SoundPackets> open_sound_packets(const SoundTrack& track) {
  if (track.video.empty() || !(track.end_seconds > track.begin_seconds)) {
    return nullptr;
  }
  SoundInput input(track);
  if (input.stream() == nullptr) {
    return nullptr;
  }
  if (input.stream()->codecpar->sample_rate <= 0) {
    input.fail("no sample rate or channels");
  }
  if (is_copied(input.stream()->codecpar->codec_id)) {
    return std::make_unique<CopiedSound>(std::move(input));
  }
  return make_encoded_sound(std::move(input));
}

}  // namespace vantage
