#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string_view>

struct AVCodecParameters;
struct AVPacket;

namespace vantage {

/// A unit of H.264 or HEVC: its header and what follows it in the packet.
using CodedUnit = std::span<const std::uint8_t>;

/// Whether `accepts` is true for one of the units of a packet, which are after start codes
/// (MPEG-TS, AVI) or after their lengths (MP4, Matroska).
bool has_coded_unit(CodedUnit packet, const AVCodecParameters& parameters,
                    const std::function<bool(CodedUnit)>& accepts);

/// "MVC" or "MV-HEVC" where the codec's header or the packet, one of the first, has further views
/// beside the one that FFmpeg decodes; else empty.
std::string_view further_views(const AVCodecParameters& parameters, const AVPacket& packet);

}  // namespace vantage
