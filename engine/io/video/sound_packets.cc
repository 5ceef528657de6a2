#include "engine/io/video/sound_packets.h"

#include <optional>

#include "engine/io/video/encoded_sound.h"
#include "engine/io/video/libav_functions.h"
#include "engine/io/video/sound_input.h"

extern "C" {
#include <libavformat/avformat.h>
}

namespace vantage {
namespace {

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
  if (is_copied(input.stream()->codecpar->codec_id)) {
    return std::make_unique<CopiedSound>(std::move(input));
  }
  return make_encoded_sound(std::move(input));
}

}  // namespace vantage
