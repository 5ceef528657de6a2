#include "engine/io/video/writing/video_join.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "engine/error.h"
#include "engine/io/files/remote_files.h"
#include "engine/io/video/libav.h"
#include "engine/io/video/libav_functions.h"
#include "engine/io/video/video_structure.h"
#include "engine/io/video/writing/sound_packets.h"
#include "engine/io/video/writing/video_muxer.h"

extern "C" {
#include <libavformat/avformat.h>
}

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// The packets of a segment, in decoding order.
class Segment {
 public:
  Segment(const fs::path& path, AVRational frame_unit)
      : path_(path),
        frame_unit_(frame_unit),
        input_(open_media_file(path)),
        stream_(find_video_stream(*input_)) {
    check_video_is_whole(path);
    if (stream_ == nullptr) {
      fail("holds no video");
    }
    read_only(*input_, *stream_);
    // Of some codecs the container alone has it.
    if (stream_->sample_aspect_ratio.num > 0) {
      stream_->codecpar->sample_aspect_ratio = stream_->sample_aspect_ratio;
    }
  }

  [[nodiscard]] const AVCodecParameters& parameters() const { return *stream_->codecpar; }

  /// Reads the next packet; its pts becomes the index of its frame. False after the last one.
  bool read(AVPacket& packet) {
    int result = fetch_packet(*input_, packet);
    while (result >= 0 && packet.stream_index != stream_->index) {
      libav().av_packet_unref(&packet);
      result = fetch_packet(*input_, packet);
    }
    if (result == AVERROR_EOF) {
      return false;
    }
    if (result < 0 || (packet.flags & AV_PKT_FLAG_CORRUPT) != 0 || packet.pts == AV_NOPTS_VALUE) {
      fail(result < 0 ? libav_message(result) : "is damaged");
    }
    const std::int64_t frame = libav().av_rescale_q(packet.pts, stream_->time_base, frame_unit_);
    // Matroska rounds times to milliseconds.
    if (libav().av_rescale_q(frame, frame_unit_, stream_->time_base) != packet.pts) {
      fail(fmt::format("has another frame rate, expected {}/{}", frame_unit_.den, frame_unit_.num));
    }
    packet.pts = frame;
    return true;
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(fmt::format("{}: {}", path_.string(), problem));
  }

 private:
  fs::path path_;
  AVRational frame_unit_;
  LibavInput input_;
  AVStream* stream_;
};

bool same_coding(const AVCodecParameters& a, const AVCodecParameters& b) {
  return a.codec_id == b.codec_id && a.width == b.width && a.height == b.height &&
         a.format == b.format && a.extradata_size == b.extradata_size &&
         (a.extradata_size == 0 ||
          std::memcmp(a.extradata, b.extradata, static_cast<std::size_t>(a.extradata_size)) == 0);
}

void check_same_coding(const Segment& segment, const Segment& first, const fs::path& first_path) {
  const AVCodecParameters& own = segment.parameters();
  const AVCodecParameters& expected = first.parameters();
  if (!same_coding(own, expected)) {
    segment.fail(fmt::format("is a video of {}x{} coded differently from {} of {}x{}", own.width,
                             own.height, first_path.string(), expected.width, expected.height));
  }
}

/// Combined properties of the segments.
struct JoinPlan {
  std::vector<int> segment_frames;
  int frames = 0;
  /// Frames by which decoding must precede presentation.
  int decoding_lead = 0;
};

/// Reads all segments once: the times of the first packet depend on the last segment.
JoinPlan plan_join(std::span<const fs::path> paths, AVRational frame_unit) {
  JoinPlan plan;
  const Segment first(paths.front(), frame_unit);
  const LibavPacket packet = make_libav_packet();
  for (const fs::path& path : paths) {
    Segment segment(path, frame_unit);
    check_same_coding(segment, first, paths.front());
    std::vector<std::int64_t> shown;
    while (segment.read(*packet)) {
      const auto lead = static_cast<std::int64_t>(shown.size()) - packet->pts;
      plan.decoding_lead = std::max(plan.decoding_lead, static_cast<int>(lead));
      shown.push_back(packet->pts);
      libav().av_packet_unref(packet.get());
    }
    std::sort(shown.begin(), shown.end());
    for (std::size_t i = 0; i < shown.size(); ++i) {
      if (shown[i] != static_cast<std::int64_t>(i)) {
        segment.fail(fmt::format("frame {} is missing", i));
      }
    }
    if (shown.empty()) {
      segment.fail("is a video without frames");
    }
    plan.segment_frames.push_back(static_cast<int>(shown.size()));
    plan.frames += plan.segment_frames.back();
  }
  return plan;
}

/// When the frames of the joined video are shown, from the first one on.
class ShownTimes {
 public:
  ShownTimes(AVRational frame_unit, const std::optional<FrameTimes>& times)
      : unit_(times ? AVRational{static_cast<int>(times->unit_numerator),
                                 static_cast<int>(times->unit_denominator)}
                    : frame_unit),
        step_(std::max<std::int64_t>(1, libav().av_rescale_q(1, frame_unit, unit_))),
        times_(times) {}

  [[nodiscard]] bool is_steady() const { return !times_; }
  [[nodiscard]] AVRational unit() const { return unit_; }
  /// From frames before the first one, at a constant rate, to the one after the last.
  [[nodiscard]] std::int64_t of(std::int64_t frame) const {
    return times_ && frame > 0
               ? times_->times[static_cast<std::size_t>(frame)] - times_->times.front()
               : frame * step_;
  }

 private:
  AVRational unit_;
  std::int64_t step_;
  const std::optional<FrameTimes>& times_;
};

/// Writes all segments, with `sound`.
void write_joined(std::span<const fs::path> segments, const JoinPlan& plan, AVRational frame_unit,
                  const ShownTimes& shown, const SoundTrack& sound, const fs::path& output) {
  const std::unique_ptr<SoundPackets> sound_packets = open_sound_packets(sound);
  bool sound_left = sound_packets != nullptr && sound_packets->next();

  VideoMuxer muxer(output);
  const int video_stream = muxer.add_stream(Segment(segments.front(), frame_unit).parameters(),
                                            shown.unit(), shown.is_steady());
  const int sound_stream =
      sound_left ? muxer.add_stream(sound_packets->parameters(), sound_packets->time_unit()) : -1;
  muxer.begin();
  const auto write_sound_before = [&](double seconds) {
    while (sound_left && sound_packets->seconds() < seconds) {
      muxer.write(sound_packets->packet(), sound_stream, sound_packets->time_unit());
      sound_left = sound_packets->next();
    }
  };
  const LibavPacket packet = make_libav_packet();
  std::int64_t decoded = 0;
  std::int64_t first_frame = 0;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    Segment segment(segments[i], frame_unit);
    while (segment.read(*packet)) {
      const std::int64_t frame = packet->pts + first_frame;
      packet->pts = shown.of(frame);
      packet->dts = shown.of(decoded - plan.decoding_lead);
      packet->duration = shown.of(frame + 1) - packet->pts;
      ++decoded;
      write_sound_before(static_cast<double>(packet->dts) * av_q2d(shown.unit()));
      muxer.write(*packet, video_stream, shown.unit());
    }
    first_frame += plan.segment_frames[i];
  }
  write_sound_before(sound.end_seconds - sound.begin_seconds);
  muxer.finish(plan.frames);
}

void require_sound_file(const SoundTrack& sound) {
  if (!sound.video.empty() && !is_there(sound.video)) {
    throw Error(
        fmt::format("cannot read {}: no such file, expected the video whose sound is copied; use "
                    "`no-sound` to write none",
                    sound.video.string()));
  }
}

}  // namespace

std::string join_videos(std::span<const fs::path> segments, FrameRate rate, const SoundTrack& sound,
                        const fs::path& output, const std::optional<FrameTimes>& times) {
  if (segments.empty()) {
    throw Error(fmt::format("cannot write {}: no videos to join", output.string()));
  }
  require_sound_file(sound);
  const AVRational frame_unit = {static_cast<int>(rate.denominator),
                                 static_cast<int>(rate.numerator)};
  const JoinPlan plan = plan_join(segments, frame_unit);
  if (times && times->frame_count() != plan.frames) {
    throw Error(fmt::format("cannot write {}: has {} frames, expected the {} whose times are known",
                            output.string(), plan.frames, times->frame_count()));
  }
  const ShownTimes shown(frame_unit, times);
  std::string problem;
  if (!sound.video.empty()) {
    try {
      write_joined(segments, plan, frame_unit, shown, sound, output);
      return "";
    } catch (const Error& error) {
      // Joining without sound shows whether the sound caused the failure.
      problem = error.what();
    }
  }
  write_joined(segments, plan, frame_unit, shown, {}, output);
  return problem;
}

}  // namespace vantage
