#include "engine/io/video/cut_video.h"

#include <cstddef>
#include <span>

#include "engine/io/video/libav_functions.h"

extern "C" {
#include <libavcodec/avcodec.h>
}

namespace vantage {
namespace {

/// Maximum number of frames that H.264 may decode before one that is shown earlier.
constexpr int kMaxReordered = 16;

bool is_fresh_start(std::uint8_t unit_header) {
  constexpr int kInstantaneousRefresh =
      5;  // unit type of IDR slices: nothing older is referenced after them
  return (unit_header & 0x1F) == kInstantaneousRefresh;
}

/// Units preceded by their length, as in MP4 and Matroska.
bool has_fresh_start(std::span<const std::uint8_t> bytes, std::size_t length_bytes) {
  while (bytes.size() > length_bytes) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < length_bytes; ++i) {
      length = length << 8 | bytes[i];
    }
    if (is_fresh_start(bytes[length_bytes])) {
      return true;
    }
    if (length >= bytes.size() - length_bytes) {
      return false;
    }
    bytes = bytes.subspan(length_bytes + length);
  }
  return false;
}

/// Units after start codes 0, 0, 1.
bool has_fresh_start(std::span<const std::uint8_t> bytes) {
  for (std::size_t i = 3; i < bytes.size(); ++i) {
    if (bytes[i - 3] == 0 && bytes[i - 2] == 0 && bytes[i - 1] == 1 && is_fresh_start(bytes[i])) {
      return true;
    }
  }
  return false;
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
  const std::span<const std::uint8_t> bytes(packet.data, static_cast<std::size_t>(packet.size));
  const bool has_lengths = parameters.extradata_size >= 7 && parameters.extradata[0] == 1;
  return has_lengths ? has_fresh_start(bytes, (parameters.extradata[4] & 3U) + 1)
                     : has_fresh_start(bytes);
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
