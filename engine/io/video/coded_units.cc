#include "engine/io/video/coded_units.h"

#include <cstddef>
#include <string_view>

extern "C" {
#include <libavcodec/avcodec.h>
}

namespace vantage {
namespace {

std::size_t number_at(CodedUnit bytes, std::size_t offset, std::size_t count) {
  std::size_t number = 0;
  for (std::size_t i = 0; i < count && offset + i < bytes.size(); ++i) {
    number = number << 8 | bytes[offset + i];
  }
  return number;
}

/// Bytes of the lengths before units; 0: there are start codes.
std::size_t bytes_of_lengths(const AVCodecParameters& parameters) {
  const bool is_h264 = parameters.codec_id == AV_CODEC_ID_H264;
  const int header = is_h264 ? 7 : 23;
  const bool has_lengths = parameters.extradata_size >= header && parameters.extradata[0] == 1;
  return has_lengths ? (parameters.extradata[is_h264 ? 4 : 21] & 3U) + 1 : 0;
}

bool has_unit_after_length(CodedUnit bytes, std::size_t length_bytes,
                           const std::function<bool(CodedUnit)>& accepts) {
  while (bytes.size() > length_bytes) {
    const std::size_t length = number_at(bytes, 0, length_bytes);
    bytes = bytes.subspan(length_bytes);
    if (accepts(bytes.first(std::min(length == 0 ? 1 : length, bytes.size())))) {
      return true;
    }
    if (length >= bytes.size()) {
      return false;
    }
    bytes = bytes.subspan(length);
  }
  return false;
}

bool has_unit_after_start_code(CodedUnit bytes, const std::function<bool(CodedUnit)>& accepts) {
  for (std::size_t i = 3; i < bytes.size(); ++i) {
    if (bytes[i - 3] == 0 && bytes[i - 2] == 0 && bytes[i - 1] == 1 && accepts(bytes.subspan(i))) {
      return true;
    }
  }
  return false;
}

/// The parameter sets of an MP4's or Matroska's header (avcC, hvcC), each after two bytes of
/// length.
bool has_unit_in_header(CodedUnit header, bool is_h264,
                        const std::function<bool(CodedUnit)>& accepts) {
  std::size_t place = is_h264 ? 5 : 22;
  const std::size_t lists = is_h264 ? 2 : number_at(header, place++, 1);
  for (std::size_t list = 0; list < lists && place < header.size(); ++list) {
    const std::size_t count = is_h264 ? number_at(header, place, 1) & (list == 0 ? 31U : 255U)
                                      : number_at(header, place + 1, 2);
    place += is_h264 ? 1 : 3;
    for (std::size_t i = 0; i < count && place + 2 < header.size(); ++i) {
      const std::size_t length = number_at(header, place, 2);
      place += 2;
      if (accepts(header.subspan(place, std::min(length, header.size() - place)))) {
        return true;
      }
      place += length;
    }
  }
  return false;
}

/// A subset of the parameters of a sequence, or a slice, of another view.
bool is_of_mvc(CodedUnit unit) {
  constexpr int kSubsetParameters = 15;
  constexpr int kSliceExtension = 20;
  constexpr int kMultiviewHigh = 118;
  constexpr int kStereoHigh = 128;
  const int type = unit.empty() ? 0 : unit[0] & 31;
  if (type == kSubsetParameters && unit.size() > 1) {
    return unit[1] == kMultiviewHigh || unit[1] == kStereoHigh;
  }
  // The bit after the header's first byte says that the slice is of scalable video instead.
  return type == kSliceExtension && unit.size() > 1 && (unit[1] & 0x80) == 0;
}

/// Of a layer other than the first, or the parameters of a video with several.
bool is_of_layers(CodedUnit unit) {
  constexpr int kVideoParameters = 32;
  if (unit.size() < 2) {
    return false;
  }
  const int type = unit[0] >> 1 & 63;
  const int layer = (unit[0] & 1) << 5 | unit[1] >> 3;
  const int further_layers = unit.size() > 3 ? (unit[2] & 3) << 4 | unit[3] >> 4 : 0;
  return type < 48 && (layer > 0 || (type == kVideoParameters && further_layers > 0));
}

}  // namespace

bool has_coded_unit(CodedUnit packet, const AVCodecParameters& parameters,
                    const std::function<bool(CodedUnit)>& accepts) {
  const std::size_t length_bytes = bytes_of_lengths(parameters);
  return length_bytes > 0 ? has_unit_after_length(packet, length_bytes, accepts)
                          : has_unit_after_start_code(packet, accepts);
}

std::string_view further_views(const AVCodecParameters& parameters, const AVPacket& packet) {
  const bool is_h264 = parameters.codec_id == AV_CODEC_ID_H264;
  if (!is_h264 && parameters.codec_id != AV_CODEC_ID_HEVC) {
    return {};
  }
  const auto accepts = is_h264 ? is_of_mvc : is_of_layers;
  const CodedUnit header(parameters.extradata, static_cast<std::size_t>(parameters.extradata_size));
  const bool in_header = bytes_of_lengths(parameters) > 0
                             ? has_unit_in_header(header, is_h264, accepts)
                             : has_unit_after_start_code(header, accepts);
  const CodedUnit coded(packet.data, static_cast<std::size_t>(packet.size));
  if (!in_header && !has_coded_unit(coded, parameters, accepts)) {
    return {};
  }
  return is_h264 ? "MVC" : "MV-HEVC";
}

}  // namespace vantage
