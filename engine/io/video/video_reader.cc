#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "engine/error.h"
#include "engine/io/video/libav_functions.h"
#include "engine/io/video/stated_format.h"
#include "engine/io/video/video_decoder.h"
#include "engine/io/video/video_io.h"
#include "engine/io/video/video_timing.h"

extern "C" {
#include <libavformat/avformat.h>
}

namespace vantage {
namespace {

/// More do not speed up small pictures, and each one holds a picture.
constexpr unsigned kMaxDecoderThreads = 4;

/// Half of the processors: a run uses all of them for other frames at the same time.
int decoder_threads() {
  return static_cast<int>(
      std::clamp(std::thread::hardware_concurrency() / 2, 1U, kMaxDecoderThreads));
}

}  // namespace

struct VideoReader::State {
  State(const std::filesystem::path& file, int wanted_track)
      : path(file), track(wanted_track), decoder(open(decoder_threads())) {}

  [[nodiscard]] std::unique_ptr<VideoDecoder> open(int threads) const {
    return std::make_unique<VideoDecoder>(path, threads, track);
  }

  std::filesystem::path path;
  int track;
  std::unique_ptr<VideoDecoder> decoder;
  PictureHandling handling;
  int width = 0;
  int height = 0;
  FilmFormat format;
  VideoTiming timing;
  std::shared_ptr<PictureConverters> converters = std::make_shared<PictureConverters>();
  int frames_read = 0;
  bool ended = false;
  std::optional<double> frame_seconds;  ///< presentation time of the last frame
  int frames_missing = 0;

  [[noreturn]] void fail(const std::string& problem) {
    ended = true;
    throw Error(fmt::format("{}: {}", name_of_track(path, track), problem));
  }

  [[noreturn]] void fail_cut_off() {
    fail(
        fmt::format("frame {} cannot be decoded (the file is cut off in or before it), expected "
                    "{} frames",
                    frames_read, timing.frames));
  }

  /// Decodes the next frame; false after the last one.
  bool advance();
  VideoDecoder::Step decode_exactly();
  /// Restarts decoding at one of the starts in first..last, the `which` one of those where it is
  /// possible. Returns empty and does nothing when there is none.
  enum class Which { kFirst, kLast };
  std::optional<int> start_within(int first, int last, Which which, int threads);
  /// As above at the last start up to `last`; frame 0 always is one.
  void start_up_to(int last, int threads);
  void forget_last_frame();
  void note_time();
};

/// Decodes again with one thread up to the next frame, which is then the damaged one or still good.
VideoDecoder::Step VideoReader::State::decode_exactly() {
  const int frame_due = frames_read;
  start_up_to(frame_due, 1);
  auto step = decoder->next();
  while (frames_read < frame_due && step == VideoDecoder::Step::kFrame) {
    ++frames_read;
    step = decoder->next();
  }
  frames_read = frame_due;
  return step;
}

std::optional<int> VideoReader::State::start_within(int first, int last, Which which, int threads) {
  std::vector<PossibleStart>& starts = timing.starts;
  std::unique_ptr<VideoDecoder> begun;
  for (;;) {
    const auto begin = std::ranges::lower_bound(starts, first, {}, &PossibleStart::frame);
    const auto end = std::ranges::upper_bound(starts, last, {}, &PossibleStart::frame);
    if (begin >= end) {
      return std::nullopt;
    }
    if (!begun) {
      begun = open(threads);
    }
    const auto start = which == Which::kFirst ? begin : end - 1;
    if (begun->start_at(*start)) {
      decoder = std::move(begun);
      frames_read = start->frame;
      return frames_read;
    }
    starts.erase(start);
  }
}

void VideoReader::State::start_up_to(int last, int threads) {
  if (!start_within(0, last, Which::kLast, threads)) {
    decoder = open(threads);
    frames_read = 0;
  }
}

void VideoReader::State::forget_last_frame() {
  ended = false;
  frame_seconds.reset();
  frames_missing = 0;
}

bool VideoReader::State::advance() {
  if (ended) {
    return false;
  }
  VideoDecoder::Step step = decoder->next();
  if (step == VideoDecoder::Step::kDamaged && !decoder->gave_all_before_damage()) {
    step = decode_exactly();
  }
  if (step == VideoDecoder::Step::kDamaged) {
    fail(fmt::format("frame {} cannot be decoded ({}), expected {} frames", frames_read,
                     decoder->problem(), timing.frames));
  }
  if (step == VideoDecoder::Step::kEnd) {
    if (timing.cut_time) {
      fail_cut_off();
    }
    const int uncertain = timing.frames_uncertain + decoder->frames_cut_off();
    if (frames_read == 0 || frames_read < timing.frames - uncertain) {
      fail(fmt::format(
          "frame {} is missing, expected {} frames (damaged, or cut without re-encoding)",
          frames_read, timing.frames));
    }
    ended = true;
    return false;
  }
  const AVFrame& frame = decoder->frame();
  if (frame.width != width || frame.height != height) {
    fail(
        fmt::format("frame {} is {}x{}, expected {}x{} as at the start: the size of the pictures "
                    "changes there",
                    frames_read, frame.width, frame.height, width, height));
  }
  note_time();
  const std::int64_t time = frame.best_effort_timestamp;
  const bool is_after_cut = (timing.cut_time && time >= *timing.cut_time) ||
                            (timing.last_decoded && time > *timing.last_decoded);
  if (is_after_cut && frames_missing > 0) {
    fail_cut_off();
  }
  ++frames_read;
  return true;
}

void VideoReader::State::note_time() {
  frames_missing = 0;
  const std::int64_t time = decoder->frame().best_effort_timestamp;
  if (time == AV_NOPTS_VALUE || !timing.rate) {
    frame_seconds.reset();
    return;
  }
  const double seconds = static_cast<double>(time) * av_q2d(decoder->stream().time_base);
  if (frame_seconds) {
    frames_missing = frames_between(*frame_seconds, seconds, *timing.rate);
  }
  frame_seconds = seconds;
}

VideoReader::VideoReader(const std::filesystem::path& path, int track)
    : state_(std::make_unique<State>(path, track)) {
  VideoDecoder& decoder = *state_->decoder;
  state_->width = decoder.stream().codecpar->width;
  state_->height = decoder.stream().codecpar->height;
  state_->handling.lossy_codec = name_of_lossy_codec(decoder.stream());
  state_->format = stated_format(decoder.stream(), nullptr);
  if (state_->format.colours.is_hdr()) {
    VideoDecoder first(path, 1, track);
    if (first.next() == VideoDecoder::Step::kFrame) {
      state_->format = stated_format(first.stream(), &first.frame());
    }
  }
  state_->timing = examine_video_timing(decoder.input(), decoder.stream(), path);
}

VideoReader::~VideoReader() = default;

void VideoReader::set_handling(const PictureHandling& handling) {
  const std::string codec = std::move(state_->handling.lossy_codec);
  state_->handling = handling;
  state_->handling.lossy_codec = codec;
}

int VideoReader::width() const { return state_->width; }
int VideoReader::height() const { return state_->height; }
std::optional<FrameRate> VideoReader::frame_rate() const { return state_->timing.rate; }
const std::optional<FrameTimes>& VideoReader::frame_times() const {
  return state_->timing.frame_times;
}
const FilmFormat& VideoReader::film_format() const { return state_->format; }
std::optional<FilmStart> VideoReader::start() const { return state_->timing.start; }
int VideoReader::frame_count() const { return state_->timing.frames; }
int VideoReader::frames_missing() const { return state_->frames_missing; }

bool VideoReader::read(VideoPicture& picture) {
  State& state = *state_;
  if (!state.advance()) {
    return false;
  }
  picture = VideoPicture(
      state.decoder->frame(), state.converters,
      fmt::format("{}: frame {}", name_of_track(state.path, state.track), state.frames_read - 1),
      state.handling);
  return true;
}

bool VideoReader::read(Photograph& frame) {
  VideoPicture picture;
  if (!read(picture)) {
    return false;
  }
  picture.convert(frame);
  return true;
}

bool VideoReader::skip() { return state_->advance(); }

std::optional<int> VideoReader::go_to_start(int first, int last) {
  State& state = *state_;
  if (first == 0) {
    state.start_up_to(last, decoder_threads());
  } else if (!state.start_within(first, last, State::Which::kLast, decoder_threads())) {
    return std::nullopt;
  }
  state.forget_last_frame();
  return state.frames_read;
}

std::optional<int> VideoReader::go_to_next_start(int first) {
  State& state = *state_;
  const std::optional<int> start = state.start_within(first, std::numeric_limits<int>::max(),
                                                      State::Which::kFirst, decoder_threads());
  if (start) {
    state.forget_last_frame();
  }
  return start;
}

}  // namespace vantage
