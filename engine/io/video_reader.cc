#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "engine/error.h"
#include "engine/io/frame_to_photograph.h"
#include "engine/io/video_decoder.h"
#include "engine/io/video_io.h"
#include "engine/io/video_timing.h"

extern "C" {
#include <libavformat/avformat.h>
}

namespace vantage {
namespace {

/// More make a small picture no faster, and every one keeps a picture.
constexpr unsigned kMaxDecoderThreads = 4;

int decoder_threads() {
  return static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, kMaxDecoderThreads));
}

}  // namespace

struct VideoReader::State {
  explicit State(const std::filesystem::path& file)
      : path(file), decoder(std::make_unique<VideoDecoder>(file, decoder_threads())) {}

  std::filesystem::path path;
  std::unique_ptr<VideoDecoder> decoder;
  bool decodes_exactly = false;  ///< with one thread, to find out which frame is damaged
  int width = 0;
  int height = 0;
  VideoTiming timing;
  FrameToPhotograph conversion;
  int frames_read = 0;
  bool ended = false;
  std::optional<double> frame_seconds;  ///< when the last frame is shown
  int frames_missing = 0;

  [[noreturn]] void fail(const std::string& problem) {
    ended = true;
    throw Error(fmt::format("{}: {}", path.string(), problem));
  }

  /// Decodes the next frame; false after the last one.
  bool advance();
  VideoDecoder::Step decode_exactly();
  void note_time();
};

/// Decodes the file anew with one thread up to the frame due, which is then the damaged one or
/// still good.
VideoDecoder::Step VideoReader::State::decode_exactly() {
  decodes_exactly = true;
  decoder = std::make_unique<VideoDecoder>(path, 1);
  auto step = decoder->next();
  for (int i = 0; i < frames_read && step == VideoDecoder::Step::kFrame; ++i) {
    step = decoder->next();
  }
  return step;
}

bool VideoReader::State::advance() {
  if (ended) {
    return false;
  }
  VideoDecoder::Step step = decoder->next();
  if (step == VideoDecoder::Step::kDamaged && !decodes_exactly) {
    step = decode_exactly();
  }
  if (step == VideoDecoder::Step::kDamaged) {
    fail(fmt::format("frame {} cannot be decoded ({}), expected {} frames", frames_read,
                     decoder->problem(), timing.frames));
  }
  if (step == VideoDecoder::Step::kEnd) {
    const int uncertain = timing.frames_uncertain + decoder->frames_cut_off();
    if (frames_read == 0 || frames_read < timing.frames - uncertain) {
      fail(
          fmt::format("frame {} is not there, expected {} frames (damaged, or cut without "
                      "re-encoding)",
                      frames_read, timing.frames));
    }
    ended = true;
    return false;
  }
  const AVFrame& frame = decoder->frame();
  if (frame.width != width || frame.height != height) {
    fail(fmt::format("frame {} is {}x{}, expected {}x{} as at the start", frames_read, frame.width,
                     frame.height, width, height));
  }
  note_time();
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
    const double steps = (seconds - *frame_seconds) * timing.rate->per_second();
    if (steps >= 1.5 && steps < 1e9) {
      frames_missing = static_cast<int>(std::lround(steps)) - 1;
    }
  }
  frame_seconds = seconds;
}

VideoReader::VideoReader(const std::filesystem::path& path)
    : state_(std::make_unique<State>(path)) {
  VideoDecoder& decoder = *state_->decoder;
  state_->width = decoder.stream().codecpar->width;
  state_->height = decoder.stream().codecpar->height;
  state_->timing = examine_video_timing(decoder.input(), decoder.stream(), path);
}

VideoReader::~VideoReader() = default;

int VideoReader::width() const { return state_->width; }
int VideoReader::height() const { return state_->height; }
std::optional<FrameRate> VideoReader::frame_rate() const { return state_->timing.rate; }
int VideoReader::frame_count() const { return state_->timing.frames; }
int VideoReader::frames_missing() const { return state_->frames_missing; }

bool VideoReader::read(Photograph& frame) {
  State& state = *state_;
  if (!state.advance()) {
    return false;
  }
  try {
    state.conversion.convert(state.decoder->frame(), frame);
  } catch (const Error& error) {
    state.fail(fmt::format("frame {}: {}", state.frames_read - 1, error.what()));
  }
  return true;
}

bool VideoReader::skip() { return state_->advance(); }

}  // namespace vantage
