#include "engine/io/video_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <type_traits>

#include "engine/error.h"
#include "engine/io/atomic_file.h"
#include "engine/io/file_bytes.h"
#include "engine/io/opencv_setup.h"
#include "engine/io/photograph_io.h"
#include "engine/io/video_structure.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

void check_is_video_file(const fs::path& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (!fs::exists(status)) {
    throw Error(fmt::format("cannot read {}: no such file", path.string()));
  }
  if (!fs::is_regular_file(status)) {
    throw Error(fmt::format("cannot read {}: expected a video file", path.string()));
  }
  std::error_code error;
  if (fs::file_size(path, error) == 0 || error) {
    throw Error(fmt::format("cannot read {}: the file is empty", path.string()));
  }
}

/// 8-bit value of any depth's, rounded.
template <typename T>
std::uint8_t to_byte(T value) {
  if constexpr (std::is_same_v<T, std::uint8_t>) {
    return value;
  } else if constexpr (std::is_same_v<T, std::uint16_t>) {
    return static_cast<std::uint8_t>((value * 255U + 32767U) / 65535U);
  } else {
    return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(value, 0.0F, 1.0F)));
  }
}

/// Fills `bgr`, which may be a column and a row larger than the image: those repeat the last.
template <typename T>
void fill_bgr(const Image<T>& image, cv::Mat& bgr) {
  for (int y = 0; y < bgr.rows; ++y) {
    const T* source = image.row(std::min(y, image.height() - 1));
    auto* target = bgr.ptr<std::uint8_t>(y);
    const int channels = image.channels();
    for (int x = 0; x < bgr.cols; ++x) {
      const T* pixel = source + std::min(x, image.width() - 1) * channels;
      target[3 * x] = to_byte(pixel[channels >= 3 ? 2 : 0]);
      target[3 * x + 1] = to_byte(pixel[channels >= 3 ? 1 : 0]);
      target[3 * x + 2] = to_byte(pixel[0]);
    }
  }
}

}  // namespace

struct VideoReader::State {
  fs::path path;
  cv::VideoCapture capture;
  cv::Mat bgr;
  int width = 0;
  int height = 0;
  std::optional<double> frames_per_second;
  std::optional<int> frame_count;
  int frames_read = 0;
  bool ended = false;

  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(fmt::format("{}: {}", path.string(), problem));
  }
};

VideoReader::VideoReader(const fs::path& path) : state_(std::make_unique<State>()) {
  prepare_opencv();
  check_is_video_file(path);
  check_video_is_whole(path);
  State& state = *state_;
  state.path = path;
  try {
    state.capture.open(path.string(), cv::CAP_FFMPEG);
    state.capture.set(cv::CAP_PROP_ORIENTATION_AUTO, 0);
  } catch (const cv::Exception&) {
    state.capture.release();
  }
  if (!state.capture.isOpened()) {
    state.fail("is not a video, or a truncated one");
  }
  state.width = static_cast<int>(state.capture.get(cv::CAP_PROP_FRAME_WIDTH));
  state.height = static_cast<int>(state.capture.get(cv::CAP_PROP_FRAME_HEIGHT));
  FileBytes({}, path.string()).check_dimensions(state.width, state.height);
  const double fps = state.capture.get(cv::CAP_PROP_FPS);
  if (std::isfinite(fps) && fps > 0) {
    state.frames_per_second = fps;
  }
  const double count = state.capture.get(cv::CAP_PROP_FRAME_COUNT);
  if (count >= 1 && count < 1e9) {
    state.frame_count = static_cast<int>(count);
  }
}

VideoReader::~VideoReader() = default;

int VideoReader::width() const { return state_->width; }
int VideoReader::height() const { return state_->height; }
std::optional<double> VideoReader::frames_per_second() const { return state_->frames_per_second; }
std::optional<int> VideoReader::frame_count() const { return state_->frame_count; }

bool VideoReader::read(Photograph& frame) {
  State& state = *state_;
  if (state.ended) {
    return false;
  }
  bool decoded = false;
  try {
    decoded = state.capture.read(state.bgr) && !state.bgr.empty();
  } catch (const cv::Exception&) {
    decoded = false;
  }
  if (!decoded) {
    state.ended = true;
    // Counts from a duration may be off by a frame or two, and more in long files.
    const int promised = state.frame_count.value_or(0);
    if (state.frames_read == 0 || state.frames_read < promised - std::max(2, promised / 50)) {
      state.fail(fmt::format(
          "frame {} cannot be decoded, expected {} frames (damaged, or cut without re-encoding)",
          state.frames_read, promised));
    }
    return false;
  }
  if (state.bgr.type() != CV_8UC3 || state.bgr.cols != state.width ||
      state.bgr.rows != state.height) {
    state.fail(fmt::format("frame {} is {}x{}, expected {}x{} as at the start", state.frames_read,
                           state.bgr.cols, state.bgr.rows, state.width, state.height));
  }
  if (!std::holds_alternative<Image<std::uint8_t>>(frame.pixels)) {
    frame.pixels = Image<std::uint8_t>();
  }
  auto& pixels = std::get<Image<std::uint8_t>>(frame.pixels);
  pixels.resize(state.width, state.height, 3);
  cv::Mat rgb(state.height, state.width, CV_8UC3, pixels.row(0), pixels.view().stride());
  cv::cvtColor(state.bgr, rgb, cv::COLOR_BGR2RGB);
  ++state.frames_read;
  return true;
}

struct VideoWriter::State {
  // Declared first: removed last, after the encoder has closed it.
  AtomicFile file;
  fs::path path;
  int width;
  int height;
  cv::VideoWriter encoder;
  cv::Mat bgr;
  int frames_written = 0;

  State(const fs::path& target, int frame_width, int frame_height)
      : file(target), path(target), width(frame_width), height(frame_height) {}

  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(fmt::format("cannot write {}: {}", path.string(), problem));
  }
};

VideoWriter::VideoWriter(const fs::path& path, int width, int height, double frames_per_second) {
  if (lower_case_extension(path) != ".mp4") {
    throw UsageError(
        fmt::format("cannot write {}: expected a video name ending in .mp4", path.string()));
  }
  constexpr int kMaxSide = 16384;
  if (width < 2 || height < 2 || width > kMaxSide || height > kMaxSide) {
    throw UsageError(fmt::format("cannot write {}: video of {}x{} pixels, expected 2..{} a side",
                                 path.string(), width, height, kMaxSide));
  }
  if (!(frames_per_second > 0 && frames_per_second <= 1000)) {
    throw UsageError(fmt::format("cannot write {}: {} frames per second, expected above 0 to 1000",
                                 path.string(), frames_per_second));
  }
  prepare_opencv();
  state_ = std::make_unique<State>(path, width, height);
  State& state = *state_;
  const cv::Size even((width + 1) / 2 * 2, (height + 1) / 2 * 2);
  state.bgr.create(even, CV_8UC3);
  try {
    state.encoder.open(state.file.temporary_path().string(), cv::CAP_FFMPEG,
                       cv::VideoWriter::fourcc('a', 'v', 'c', '1'), frames_per_second, even);
  } catch (const cv::Exception&) {
    state.encoder.release();
  }
  if (!state.encoder.isOpened()) {
    state.fail("no H.264 encoder for this size and rate");
  }
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::write(const Photograph& frame) {
  State& state = *state_;
  if (frame.width() != state.width || frame.height() != state.height) {
    state.fail(fmt::format("frame {} is {}x{}, expected {}x{}", state.frames_written, frame.width(),
                           frame.height(), state.width, state.height));
  }
  std::visit([&](const auto& image) { fill_bgr(image, state.bgr); }, frame.pixels);
  try {
    state.encoder.write(state.bgr);
  } catch (const cv::Exception&) {
    state.fail(fmt::format("frame {} cannot be encoded", state.frames_written));
  }
  ++state.frames_written;
}

void VideoWriter::finish() {
  State& state = *state_;
  if (state.frames_written == 0) {
    state.fail("the video has no frames");
  }
  state.encoder.release();
  // The encoder does not say when the disk was full: the index at the end is missing then.
  std::optional<int> stored;
  try {
    stored = VideoReader(state.file.temporary_path()).frame_count();
  } catch (const Error&) {
    stored.reset();
  }
  if (stored != state.frames_written) {
    state.fail(fmt::format("{} of {} frames were stored (disk full?)", stored.value_or(0),
                           state.frames_written));
  }
  state.file.commit();
}

}  // namespace vantage
