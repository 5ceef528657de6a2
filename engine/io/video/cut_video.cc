#include "engine/io/video/cut_video.h"

#include <cstddef>

#include "engine/io/video/coded_units.h"
#include "engine/io/video/libav_functions.h"

extern "C" {
#include <libavcodec/avcodec.h>
}

namespace vantage {
namespace {

/// Maximum number of frames that H.264 may decode before one that is shown earlier.
constexpr int kMaxReordered = 16;

bool is_fresh_start(CodedUnit unit) {
  constexpr int kInstantaneousRefresh =
      5;  // unit type of IDR slices: nothing older is referenced after them
  return (unit[0] & 0x1F) == kInstantaneousRefresh;
}

}  // namespace

bool begins_afresh(const AVPacket& packet, const AVCodecParameters& parameters) {
  const AVCodecDescriptor* coding = libav().avcodec_descriptor_get(parameters.codec_id);
  if (coding != nullptr && (coding->props & AV_CODEC_PROP_INTRA_ONLY) != 0) {
    return true;
  }
  if (parameters.codec_id != AV_CODEC_ID_H264) {
    return false;
  }
  return has_coded_unit({packet.data, static_cast<std::size_t>(packet.size)}, parameters,
                        is_fresh_start);
}

bool CutVideo::is_cut_off(const AVPacket& packet) {
  if (parameters_->codec_id != AV_CODEC_ID_H264) {
    return false;
  }
  const bool key = (packet.flags & AV_PKT_FLAG_KEY) != 0;
  if (packets_ == 0) {
    first_time_ = packet.pts;
    misses_frames_ = key && !begins_afresh(packet, *parameters_);
  } else if (key) {
    misses_frames_ = false;
  }
  if (packets_ > kMaxReordered) {
    return false;
  }
  ++packets_;
  const bool cut_off = misses_frames_ && packet.pts < first_time_;
  frames_cut_off_ += cut_off ? 1 : 0;
  return cut_off;
}

}  // namespace vantage
