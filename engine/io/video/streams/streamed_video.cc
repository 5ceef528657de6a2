#include "engine/io/video/streams/streamed_video.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "engine/error.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/video/libav_functions.h"
#include "engine/io/video/stated_format.h"
#include "engine/io/video/video_decoder.h"
#include "scheduler/interruption.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

namespace vantage {
namespace {

bool is_of_raw_frames(const AVFormatContext& input) {
  const std::string_view name = input.iformat->name;
  return name == "yuv4mpegpipe" || name == "rawvideo";
}

}  // namespace

StreamedVideo::StreamedVideo(std::unique_ptr<StreamInput> bytes,
                             const std::optional<RawVideoShape>& raw, FrameRate raw_rate)
    : bytes_(std::move(bytes)),
      input_(bytes_->open(raw, raw_rate)),
      stream_(find_video_stream(*input_)),
      codec_(open_decoder(*stream_, 1, bytes_->shown_name())),
      packet_(make_libav_packet()),
      frame_(make_libav_frame()),
      is_raw_(is_of_raw_frames(*input_)),
      lossy_codec_(name_of_lossy_codec(*stream_)) {
  const AVCodecParameters& parameters = *stream_->codecpar;
  if (parameters.width == 0 || parameters.height == 0) {
    throw Error(fmt::format("{}: none of its frames can be decoded", bytes_->shown_name()));
  }
  FileBytes({}, bytes_->shown_name()).check_dimensions(parameters.width, parameters.height);
  read_only(*input_, *stream_);
  if (!decode_next(first_)) {
    if (bytes_->is_stopped()) {
      throw scheduler::Interrupted();
    }
    throw Error(fmt::format("{}: is empty, expected a video", bytes_->shown_name()));
  }
  format_ = stated_format(*stream_, frame_.get());
  const AVRational rate = stream_->avg_frame_rate.num > 0 ? stream_->avg_frame_rate
                          : stream_->r_frame_rate.num > 0 ? stream_->r_frame_rate
                                                          : codec_->framerate;
  const auto stated = parse_frame_rate(fmt::format("{}/{}", rate.num, rate.den));
  rate_ = stated.value_or(raw_rate);
  if (!stated) {
    remarks_.push_back(fmt::format("{}: states no frame rate, taken as {}; `fps` gives another",
                                   bytes_->shown_name(), to_string(rate_)));
  }
}

void StreamedVideo::fail_cut() {
  ended_ = true;
  throw Error(fmt::format("{}: the stream ends inside it or is damaged", describe(decoded_)));
}

void StreamedVideo::note_damage(int result) {
  if (is_raw_) {
    fail_cut();
  }
  damage_ = result;
  waits_for_key_frame_ = true;
  libav().avcodec_send_packet(codec_.get(), nullptr);
}

void StreamedVideo::fail_damaged() {
  libav().avcodec_flush_buffers(codec_.get());
  ++left_out_;
  throw Error(fmt::format("{}: is damaged ({}), and what depends on it", describe(decoded_++),
                          libav_message(std::exchange(damage_, 0))));
}

void StreamedVideo::feed() {
  int result = 0;
  do {
    libav().av_packet_unref(packet_.get());
    bytes_->allow_silence();
    result = fetch_packet(*input_, *packet_);
  } while (result >= 0 && packet_->stream_index != stream_->index);
  const bool is_whole = result >= 0 && (packet_->flags & AV_PKT_FLAG_CORRUPT) == 0;
  if (!is_whole && bytes_->is_stopped()) {
    ended_ = true;
    return;
  }
  if (result == AVERROR_EOF) {
    // The reader of y4m takes a part of a frame for the end, too.
    const AVIOContext* io = input_->pb;
    if (is_raw_ && frames_end_ >= 0 && io->pos - (io->buf_end - io->buf_ptr) > frames_end_) {
      fail_cut();
    }
    libav().avcodec_send_packet(codec_.get(), nullptr);
    return;
  }
  if (result < 0 && !is_raw_) {
    ended_ = true;
    throw Error(
        fmt::format("{}: cannot be read ({})", describe(decoded_), bytes_->problem(result)));
  }
  frames_end_ = packet_->pos >= 0 ? packet_->pos + packet_->size : -1;
  if (!is_whole) {
    note_damage(AVERROR_INVALIDDATA);
    return;
  }
  if (waits_for_key_frame_ && (packet_->flags & AV_PKT_FLAG_KEY) == 0) {
    return;
  }
  waits_for_key_frame_ = false;
  result = libav().avcodec_send_packet(codec_.get(), packet_.get());
  if (result < 0) {
    note_damage(result);
  }
}

void StreamedVideo::note_time() {
  const std::int64_t time = frame_->best_effort_timestamp;
  const std::optional<double> before_s = std::exchange(shown_s_, std::nullopt);
  if (time != AV_NOPTS_VALUE) {
    shown_s_ = static_cast<double>(time) * av_q2d(stream_->time_base);
  }
  // Elsewhere a gap is the camera's: its times follow no rate exactly.
  const int left_out = std::exchange(left_out_, 0);
  const int gap =
      left_out > 0 && before_s && shown_s_ ? frames_between(*before_s, *shown_s_, rate_) : 0;
  frames_missing_ = std::max(0, gap - left_out);
}

bool StreamedVideo::decode_next(VideoPicture& picture) {
  while (!ended_) {
    const int result = libav().avcodec_receive_frame(codec_.get(), frame_.get());
    if (result == AVERROR(EAGAIN)) {
      feed();
      continue;
    }
    // Frames before the damage are shown first: the decoder may have held some back.
    if (damage_ != 0 && result < 0) {
      fail_damaged();
    }
    if (result == AVERROR_EOF) {
      ended_ = true;
      break;
    }
    if (result < 0 || frame_->decode_error_flags != 0 ||
        (frame_->flags & AV_FRAME_FLAG_CORRUPT) != 0) {
      if (damage_ == 0) {
        note_damage(result < 0 ? result : AVERROR_INVALIDDATA);
      }
      continue;
    }
    note_time();
    picture = VideoPicture(*frame_, converters_, describe(decoded_), {.lossy_codec = lossy_codec_});
    ++decoded_;
    return true;
  }
  return false;
}

bool StreamedVideo::fetch(FetchedFrame& frame) {
  frame.file.clear();
  frame.picture = std::move(first_);
  frame.frames_missing = 0;
  frame.remarks = std::exchange(remarks_, {});
  if (!frame.picture.is_empty()) {
    return true;
  }
  if (!decode_next(frame.picture)) {
    return false;
  }
  frame.note_missing(frames_missing_, describe(decoded_ - 1));
  return true;
}

void StreamedVideo::skip_to(int index) {
  const int next = decoded_ - (first_.is_empty() ? 0 : 1);
  if (index < next) {
    throw Error(fmt::format("{}: is over, expected frames in order", describe(index)));
  }
  if (index > next) {
    first_ = {};
  }
  VideoPicture dropped;
  while (decoded_ < index && decode_next(dropped)) {
  }
}

std::string StreamedVideo::describe(int index) const {
  return fmt::format("{} frame {}", bytes_->shown_name(), index);
}

}  // namespace vantage
