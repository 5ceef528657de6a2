#include "engine/io/video/video_timing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/error.h"
#include "engine/io/files/remote_files.h"
#include "engine/io/video/cut_video.h"
#include "engine/io/video/libav.h"
#include "engine/io/video/libav_functions.h"
#include "engine/io/video/video_structure.h"
#include "engine/order_statistics.h"

extern "C" {
#include <libavformat/avformat.h>
}

namespace vantage {
namespace {

struct PacketTimes {
  std::vector<std::int64_t> times;  ///< in the stream's unit, of the packets that have one
  std::size_t packets = 0;          ///< number of packets that show a frame
  std::int64_t last_length = 0;     ///< how long the last frame is shown; 0 if not known
  /// Earliest decoding time of the first missing packet; its presentation is later.
  std::optional<std::int64_t> cut_time;
  /// Decoding time of the last packet of a stream without a defined end.
  std::optional<std::int64_t> last_decoded;

  void add(std::int64_t time) {
    ++packets;
    if (time != AV_NOPTS_VALUE) {
      times.push_back(time);
    }
  }
};

bool has_whole_index(const AVFormatContext& input, const AVStream& stream) {
  return std::string_view(input.iformat->name).find("mp4") != std::string_view::npos &&
         stream.nb_frames > 0 && libav().avformat_index_get_entries_count(&stream) > 0;
}

PacketTimes read_index(AVStream& stream, std::uint64_t file_bytes) {
  PacketTimes result;
  for (int i = 0; i < libav().avformat_index_get_entries_count(&stream); ++i) {
    const AVIndexEntry* entry = libav().avformat_index_get_entry(&stream, i);
    // An edit list hides frames that others need: they are decoded and not shown.
    if ((entry->flags & AVINDEX_DISCARD_FRAME) == 0 && entry->size > 0) {
      result.add(entry->timestamp);
    }
    if (!result.cut_time && static_cast<std::uint64_t>(entry->pos + entry->size) > file_bytes) {
      result.cut_time = entry->timestamp;
    }
  }
  if (!result.times.empty() && stream.duration > 0) {
    result.last_length = result.times.front() + stream.duration - result.times.back();
  }
  return result;
}

bool is_interlaced(const AVStream& stream) {
  const AVFieldOrder order = stream.codecpar->field_order;
  return order != AV_FIELD_UNKNOWN && order != AV_FIELD_PROGRESSIVE;
}

/// Starts in an index. Packets before a start are presented before it, so their count is its frame
/// index.
std::vector<PossibleStart> find_starts(AVStream& stream) {
  std::vector<PossibleStart> starts;
  int frame = 0;
  for (int i = 0; i < libav().avformat_index_get_entries_count(&stream); ++i) {
    const AVIndexEntry* entry = libav().avformat_index_get_entry(&stream, i);
    if ((entry->flags & AVINDEX_DISCARD_FRAME) != 0 || entry->size == 0) {
      continue;
    }
    if (frame > 0 && (entry->flags & AVINDEX_KEYFRAME) != 0) {
      starts.push_back({frame, entry->timestamp, entry->pos});
    }
    ++frame;
  }
  return starts;
}

bool shows_a_frame(const AVPacket& packet, AVCodecID codec) {
  if (packet.size == 0 || (packet.flags & AV_PKT_FLAG_DISCARD) != 0) {
    return false;
  }
  // VP8 flags, in its first byte, frames that are only references for others.
  return codec != AV_CODEC_ID_VP8 || (packet.data[0] & 0x10) != 0;
}

/// Whether there is data after the last complete frame of raw video, `frames_end` bytes into the
/// file.
bool is_cut_raw_video(const AVFormatContext& input, std::int64_t frames_end,
                      std::uint64_t file_bytes) {
  return std::string_view(input.iformat->name) == "yuv4mpegpipe" &&
         file_bytes > static_cast<std::uint64_t>(frames_end);
}

bool is_mpeg_stream(const AVFormatContext& input) {
  const std::string_view container = input.iformat->name;
  return container == "mpegts" || container == "mpeg";
}

PacketTimes read_packets(const std::filesystem::path& path, int stream_index, bool is_whole) {
  const LibavInput input = open_media_file(path);
  if (static_cast<unsigned>(stream_index) >= input->nb_streams) {
    return {};
  }
  const AVStream& stream = *input->streams[stream_index];
  read_only(*input, stream);
  const LibavPacket packet = make_libav_packet();
  const AVCodecID codec = stream.codecpar->codec_id;
  CutVideo cut(*stream.codecpar);
  bool key_seen = false;
  std::int64_t last_decoded = AV_NOPTS_VALUE;
  std::int64_t last_shown = AV_NOPTS_VALUE;
  std::int64_t frames_end = std::numeric_limits<std::int64_t>::max();
  PacketTimes result;
  while (fetch_packet(*input, *packet) >= 0) {
    const bool is_torn = !is_whole && (packet->flags & AV_PKT_FLAG_CORRUPT) != 0;
    if (packet->stream_index == stream_index && !is_torn && !cut.is_cut_off(*packet) &&
        shows_a_frame(*packet, codec)) {
      if (!key_seen && (packet->flags & AV_PKT_FLAG_KEY) != 0) {
        result = {};  // the first frames of a mid-programme recording cannot be decoded
        key_seen = true;
      }
      const std::int64_t time = packet->pts != AV_NOPTS_VALUE ? packet->pts : packet->dts;
      if (result.times.empty() || time >= last_shown) {
        last_shown = time;
        result.last_length = packet->duration;
      }
      result.add(time);
      last_decoded = packet->dts;
      frames_end = packet->pos + packet->size;
    }
    libav().av_packet_unref(packet.get());
  }
  if (const int error = read_error(*input); error < 0) {
    throw Error(fmt::format("cannot read {}: {}", path.string(), libav_message(error)));
  }
  if (!is_whole || is_cut_raw_video(*input, frames_end, bytes_of_file(path))) {
    result.cut_time = last_decoded == AV_NOPTS_VALUE ? last_decoded : last_decoded + 1;
    ++result.packets;
  }
  if (is_mpeg_stream(*input) && last_decoded != AV_NOPTS_VALUE) {
    result.last_decoded = last_decoded;
  }
  return result;
}

/// Median of the steps between ascending times; 0 when there is none.
std::int64_t usual_step(const std::vector<std::int64_t>& times) {
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i] > times[i - 1]) {
      steps.push_back(times[i] - times[i - 1]);
    }
  }
  if (steps.empty()) {
    return 0;
  }
  return upper_median(steps);
}

std::optional<FrameRate> to_frame_rate(AVRational rate) {
  if (rate.num <= 0 || rate.den <= 0) {
    return std::nullopt;
  }
  int numerator = 0;
  int denominator = 0;
  constexpr int kLargestTerm = 1'000'000;
  libav().av_reduce(&numerator, &denominator, rate.num, rate.den, kLargestTerm);
  if (numerator < 1 || denominator < 1 || numerator / denominator >= 1000) {
    return std::nullopt;
  }
  return FrameRate{numerator, denominator};
}

/// Frames divided by length is too low if frames are missing, and a guess from the first frames is
/// wrong if their times are rounded: uses the one closer to the median step.
std::optional<FrameRate> choose_rate(const AVStream& stream, double step_seconds) {
  const std::optional<FrameRate> average = to_frame_rate(stream.avg_frame_rate);
  const std::optional<FrameRate> guess = to_frame_rate(stream.r_frame_rate);
  if (!average || !guess || step_seconds <= 0) {
    return average ? average : guess;
  }
  const auto error = [&](const FrameRate& rate) {
    return std::abs(std::log(rate.per_second() * step_seconds));
  };
  return error(*guess) < error(*average) ? guess : average;
}

/// Empty if the rate is not variable, or not all times are known. `step`: usual length of a frame.
std::optional<FrameTimes> variable_times(PacketTimes packets, const VideoTiming& timing,
                                         const AVStream& stream, std::int64_t step) {
  std::vector<std::int64_t> times = std::move(packets.times);
  std::ranges::sort(times);
  const auto frames = static_cast<std::size_t>(timing.frames);
  if (times.size() > frames || (times.size() < frames && !timing.cut_time) ||
      std::ranges::adjacent_find(times) != times.end() ||
      !are_uneven(times, av_q2d(stream.time_base), *timing.rate)) {
    return std::nullopt;
  }
  while (times.size() < frames) {
    times.push_back(times.back() + step);  // of frames that are cut off
  }
  times.push_back(times.back() + (packets.last_length > 0 ? packets.last_length : step));
  const std::int64_t start = times.front();
  for (std::int64_t& time : times) {
    time -= start;
  }
  return FrameTimes{std::move(times), stream.time_base.num, stream.time_base.den, *timing.rate};
}

/// Packets of interlaced video may hold half a frame. Without an index, some packets may not be
/// frames.
int uncertain_frames(int frames, bool from_index, bool interlaced) {
  if (interlaced) {
    return (frames + 1) / 2;
  }
  return from_index ? 0 : std::max(2, frames / 50);
}

}  // namespace

VideoTiming examine_video_timing(AVFormatContext& input, AVStream& stream,
                                 const std::filesystem::path& path) {
  const bool is_whole = find_video_extent(path) == VideoExtent::kWhole;
  const bool from_index = has_whole_index(input, stream);
  PacketTimes packets = from_index ? read_index(stream, bytes_of_file(path))
                                   : read_packets(path, stream.index, is_whole);
  if (packets.packets == 0 || packets.packets > std::numeric_limits<int>::max()) {
    throw Error(fmt::format("{}: is a video without frames", path.string()));
  }
  VideoTiming timing;
  timing.frames = static_cast<int>(packets.packets);
  timing.frames_uncertain = uncertain_frames(timing.frames, from_index, is_interlaced(stream));
  if (from_index && !is_interlaced(stream)) {
    timing.starts = find_starts(stream);
  }
  timing.cut_time = packets.cut_time;
  timing.last_decoded = packets.last_decoded;
  std::ranges::sort(packets.times);
  const std::int64_t step = usual_step(packets.times);
  timing.rate = choose_rate(stream, static_cast<double>(step) * av_q2d(stream.time_base));
  const double unit_s = av_q2d(stream.time_base);
  const bool is_uneven = timing.rate && are_uneven(packets.times, unit_s, *timing.rate);
  if (is_uneven && !is_interlaced(stream)) {
    if (from_index && stream.codecpar->video_delay > 0) {
      packets = read_packets(path, stream.index, is_whole);  // the index has times of decoding
    }
    timing.frame_times = variable_times(packets, timing, stream, step);
  }
  if (timing.rate && !packets.times.empty() && (timing.frame_times || !is_uneven)) {
    // The index has times of decoding.
    const std::int64_t first = from_index && stream.start_time != AV_NOPTS_VALUE
                                   ? stream.start_time
                                   : std::ranges::min(packets.times);
    timing.start = {.seconds = static_cast<double>(first) * unit_s,
                    .has_clock = (input.iformat->flags & AVFMT_TS_DISCONT) != 0};
  }
  return timing;
}

}  // namespace vantage
