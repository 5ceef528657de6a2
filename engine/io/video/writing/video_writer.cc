#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "engine/error.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/video/libav_functions.h"
#include "engine/io/video/video_io.h"
#include "engine/io/video/writing/frame_conversion.h"
#include "engine/io/video/writing/picture_group.h"
#include "engine/io/video/writing/video_encoder.h"
#include "engine/io/video/writing/video_muxer.h"

extern "C" {
#include <libavcodec/avcodec.h>
}

namespace vantage {
namespace {

void check_video_settings(const std::filesystem::path& path, int width, int height,
                          const VideoEncoding& encoding) {
  const std::string extension = fmt::format(".{}", traits_of(encoding.coding).extension);
  if (lower_case_extension(path) != extension) {
    throw UsageError(fmt::format("cannot write {}: expected a video name ending in {}",
                                 path.string(), extension));
  }
  constexpr int kMaxSide = 16384;
  if (width < 2 || height < 2 || width > kMaxSide || height > kMaxSide) {
    throw UsageError(fmt::format("cannot write {}: video of {}x{} pixels, expected 2..{} a side",
                                 path.string(), width, height, kMaxSide));
  }
  const FrameRate& rate = encoding.rate;
  const auto is_term = [](std::int64_t value) { return value >= 1 && value <= 1'000'000; };
  if (!is_term(rate.numerator) || !is_term(rate.denominator) || rate.per_second() > 1000) {
    throw UsageError(fmt::format("cannot write {}: {} frames per second, expected above 0 to 1000",
                                 path.string(), to_string(rate)));
  }
  if (encoding.crf < 0 || encoding.crf > 51) {
    throw UsageError(fmt::format("cannot write {}: rate factor is {}, expected 0 to 51",
                                 path.string(), encoding.crf));
  }
}

/// Encoders use much memory on whichever thread they run, and the allocator keeps freed memory per
/// thread: without this a run grows from group to group for a while.
void return_free_memory() {
#ifdef __GLIBC__
  (void)::malloc_trim(0);
#endif
}

AVRational time_unit_of(FrameRate rate) {
  return {static_cast<int>(rate.denominator), static_cast<int>(rate.numerator)};
}

}  // namespace

struct VideoWriter::State {
  /// One that waits or is encoded.
  struct Group {
    PictureGroup pictures;
    bool is_at_work = false;
  };

  VideoEncoding encoding;
  int width;
  int height;
  AVRational time_unit;
  FrameConversion convert;  ///< made for the first photograph
  int decoding_lead = 0;    ///< frames by which decoding may precede presentation
  std::mutex mutex;
  std::condition_variable changed;
  // Guarded by it.
  VideoMuxer file;
  std::deque<Group> groups;  ///< in order, those that are not in the file
  std::vector<LibavCodec> idle_encoders;
  int frames = 0;
  int packets_stored = 0;
  std::exception_ptr error;

  State(const std::filesystem::path& path, int frame_width, int frame_height,
        const VideoEncoding& video_encoding)
      : encoding(video_encoding),
        width(frame_width),
        height(frame_height),
        time_unit(time_unit_of(encoding.rate)),
        file(path) {
    LibavCodec encoder = open_encoder();
    AVCodecParameters* parameters = libav().avcodec_parameters_alloc();
    if (parameters == nullptr ||
        libav().avcodec_parameters_from_context(parameters, encoder.get()) < 0) {
      libav().avcodec_parameters_free(&parameters);
      throw std::bad_alloc();
    }
    file.add_stream(*parameters, time_unit);
    libav().avcodec_parameters_free(&parameters);
    file.begin();
    decoding_lead = encoder->has_b_frames;
    idle_encoders.push_back(std::move(encoder));
  }

  [[nodiscard]] int group_frames() const { return traits_of(encoding.coding).group_frames; }
  LibavCodec open_encoder();
  LibavCodec take_encoder();
  void require_no_error() const {
    if (error) {
      std::rethrow_exception(error);
    }
  }
  [[nodiscard]] int frames_waiting() const {
    int frames_left = 0;
    for (const Group& group : groups) {
      frames_left += group.pictures.frames_waiting();
    }
    return frames_left;
  }
  void add(LibavFrame frame);
  Group* find_work();
  void encode(Group& group, std::unique_lock<std::mutex>& lock);
  void store_coded_groups();
};

LibavCodec VideoWriter::State::open_encoder() {
  EncoderSetup setup(encoding, width, height);
  int result = 0;
  LibavCodec encoder = setup.open(result);
  if (result == AVERROR_ENCODER_NOT_FOUND) {
    file.fail(fmt::format("this FFmpeg was built without the encoder {}", setup.name()));
  }
  if (result < 0) {
    file.fail(fmt::format("no encoder {} for {}x{} pixels and {} frames per second ({})",
                          setup.name(), width, height, to_string(encoding.rate),
                          libav_message(result)));
  }
  return encoder;
}

LibavCodec VideoWriter::State::take_encoder() {
  {
    const std::lock_guard lock(mutex);
    if (!idle_encoders.empty()) {
      LibavCodec encoder = std::move(idle_encoders.back());
      idle_encoders.pop_back();
      return encoder;
    }
  }
  return open_encoder();
}

void VideoWriter::State::add(LibavFrame frame) {
  const std::lock_guard lock(mutex);
  require_no_error();
  if (groups.empty() || groups.back().pictures.is_closed()) {
    groups.push_back({PictureGroup(frames)});
  }
  PictureGroup& group = groups.back().pictures;
  group.add(std::move(frame));
  ++frames;
  if (group.frames() == group_frames()) {
    group.close();
  }
}

/// A group that may be encoded now; null: none.
VideoWriter::State::Group* VideoWriter::State::find_work() {
  if (error) {
    return nullptr;
  }
  const bool may_open = frames_waiting() > std::max(2, group_frames() / 3);
  const auto group = std::ranges::find_if(groups, [&](const Group& one) {
    return !one.is_at_work && one.pictures.has_work() &&
           (one.pictures.is_open() || may_open || &one == &groups.front());
  });
  return group != groups.end() ? &*group : nullptr;
}

/// `lock`: of the mutex, which is free while the encoder works.
void VideoWriter::State::encode(Group& group, std::unique_lock<std::mutex>& lock) {
  group.is_at_work = true;
  LibavFrame frame = group.pictures.take_frame();
  lock.unlock();
  std::exception_ptr problem;
  try {
    group.pictures.encode(frame.get(), [this] { return take_encoder(); });
    frame.reset();
  } catch (const Error& bad) {
    problem = std::make_exception_ptr(
        Error(fmt::format("cannot write {}: {}", file.path().string(), bad.what())));
  } catch (...) {
    problem = std::current_exception();
  }
  lock.lock();
  group.is_at_work = false;
  try {
    if (problem) {
      std::rethrow_exception(problem);
    }
    group.pictures.note_packets();
    if (group.pictures.is_coded()) {
      LibavCodec encoder = group.pictures.take_encoder();
      if (group_frames() == 1) {
        idle_encoders.push_back(std::move(encoder));
      } else {
        encoder.reset();
        return_free_memory();
      }
      store_coded_groups();
    }
  } catch (...) {
    error = std::current_exception();
  }
  changed.notify_all();
}

/// Those that no earlier one is missing for.
void VideoWriter::State::store_coded_groups() {
  for (; !groups.empty() && groups.front().pictures.is_coded(); groups.pop_front()) {
    for (const LibavPacket& packet : groups.front().pictures.packets()) {
      packet->dts = packets_stored++ - decoding_lead;
      file.write(*packet, 0, time_unit);
    }
  }
}

VideoWriter::VideoWriter(const std::filesystem::path& path, int width, int height,
                         const VideoEncoding& encoding) {
  check_video_settings(path, width, height, encoding);
  state_ = std::make_unique<State>(path, width, height, encoding);
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::write(const Photograph& frame) {
  State& state = *state_;
  if (frame.width() != state.width || frame.height() != state.height) {
    state.file.fail(fmt::format("frame {} is {}x{}, expected {}x{}", state.frames, frame.width(),
                                frame.height(), state.width, state.height));
  }
  if (!state.convert) {
    state.convert = make_frame_conversion(state.encoding.coding, state.width, state.height,
                                          state.encoding.format.colours);
  }
  add(state.convert(frame));
  while (encode_some()) {
  }
  const std::lock_guard lock(state.mutex);
  state.require_no_error();
}

void VideoWriter::add(LibavFrame frame) { state_->add(std::move(frame)); }

bool VideoWriter::encode_some() {
  std::unique_lock lock(state_->mutex);
  State::Group* group = state_->find_work();
  if (group == nullptr) {
    return false;
  }
  state_->encode(*group, lock);
  return true;
}

int VideoWriter::frames_waiting() const {
  const std::lock_guard lock(state_->mutex);
  return state_->frames_waiting();
}

void VideoWriter::end() {
  const std::lock_guard lock(state_->mutex);
  state_->require_no_error();
  if (state_->frames == 0) {
    state_->file.fail("the video has no frames");
  }
  if (!state_->groups.empty()) {
    state_->groups.back().pictures.close();
  }
}

void VideoWriter::rename(const std::filesystem::path& path) {
  const std::lock_guard lock(state_->mutex);
  state_->file.rename(path);
}

void VideoWriter::finish() {
  end();
  std::unique_lock lock(state_->mutex);
  while (!state_->groups.empty() && !state_->error) {
    if (State::Group* group = state_->find_work()) {
      state_->encode(*group, lock);
    } else {
      // Another thread is at work. It may leave a group when it has encoded a part of it.
      state_->changed.wait(lock);
    }
  }
  state_->require_no_error();
  state_->file.finish(state_->frames);
}

}  // namespace vantage
