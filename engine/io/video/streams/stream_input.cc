#include "engine/io/video/streams/stream_input.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <cerrno>
#include <new>
#include <utility>

#include "engine/error.h"
#include "engine/io/video/libav_functions.h"
#include "engine/late_library.h"
#include "scheduler/interruption.h"

extern "C" {
#include <libavformat/avformat.h>
#include <libavutil/macros.h>
#include <libavutil/mem.h>
#include <libavutil/pixdesc.h>
}

namespace vantage {
namespace {

constexpr const char* kStandardInput = "-";
constexpr int kInputBufferBytes = 1 << 16;
constexpr int kPipeBytes = 1 << 20;  // what Linux gives to everyone
constexpr int kStopInterval_ms = 100;
constexpr std::chrono::seconds kConnecting{10};
constexpr std::chrono::seconds kSilence{60};
/// No protocol: nothing else may be opened.
constexpr const char* kNothing = "none";

/// Without user and password.
std::string without_user(const std::string& address) {
  const std::size_t begin = address.find("://") + 3;
  const std::size_t at = address.find('@', begin);
  return at < address.find('/', begin) ? address.substr(0, begin) + address.substr(at + 1)
                                       : address;
}

/// Adds the demultiplexers of cameras to libavformat's. Versions of both libraries go together.
void register_cameras() {
  static const LateLibrary library(
      "libavdevice.so." AV_STRINGIFY(LIBAVFORMAT_VERSION_MAJOR),
      "cannot read cameras (Debian: libavdevice" AV_STRINGIFY(LIBAVFORMAT_VERSION_MAJOR) ")");
  library.function<void (*)()>("avdevice_register_all")();
}

/// FFmpeg's options of raw frames, and of modes of a camera.
void set_shape(const RawVideoShape& raw, FrameRate rate, AVDictionary** options) {
  if (libav().av_get_pix_fmt(raw.pixel_format.c_str()) == AV_PIX_FMT_NONE) {
    throw UsageError(
        fmt::format("raw-video has the pixel format '{}', expected one of FFmpeg's such as rgb24, "
                    "gray, yuv420p",
                    raw.pixel_format));
  }
  libav().av_dict_set(options, "video_size",
                      fmt::format("{}x{}", raw.width_px, raw.height_px).c_str(), 0);
  libav().av_dict_set(options, "pixel_format", raw.pixel_format.c_str(), 0);
  libav().av_dict_set(options, "framerate", to_string(rate).c_str(), 0);
}

}  // namespace

StreamInput::Kind StreamInput::kind_of(const std::string& name) {
  constexpr unsigned kVideo4Linux = 81;  // Linux's number of the driver
  if (name.starts_with("tcp://") || name.starts_with("rtsp://")) {
    return name.starts_with("tcp") ? Kind::kTcp : Kind::kRtsp;
  }
  struct stat status {};
  if (name == kStandardInput || (::stat(name.c_str(), &status) == 0 && S_ISFIFO(status.st_mode))) {
    return Kind::kPipe;
  }
  return S_ISCHR(status.st_mode) && major(status.st_rdev) == kVideo4Linux ? Kind::kCamera
                                                                          : Kind::kNone;
}

StreamInput::StreamInput(std::string name, const std::atomic<bool>* stop)
    : name_(std::move(name)),
      shown_name_(is_of_network() ? without_user(name_) : name_),
      stop_(stop) {
  silence_libav();
  if (kind_ == Kind::kTcp) {
    connect();
  } else if (kind_ == Kind::kPipe) {
    open_pipe();
  }
}

StreamInput::~StreamInput() {
  if (kind_ == Kind::kTcp) {
    libav().avio_closep(&io_);
  } else if (io_ != nullptr) {
    libav().av_freep(&io_->buffer);  // libav may have exchanged it
    libav().avio_context_free(&io_);
  }
  if (descriptor_ > STDIN_FILENO) {
    ::close(descriptor_);
  }
}

void StreamInput::fail(const std::string& problem) const {
  throw Error(fmt::format("{}: {}", shown_name_, problem));
}

void StreamInput::open_pipe() {
  if (name_ == kStandardInput) {
    shown_name_ = "standard input";
    descriptor_ = STDIN_FILENO;
  } else {
    descriptor_ = ::open(name_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor_ < 0) {
      fail(fmt::format("cannot be opened ({})", libav_message(AVERROR(errno))));
    }
    (void)::fcntl(descriptor_, F_SETPIPE_SZ, kPipeBytes);
  }
  auto* const buffer = static_cast<unsigned char*>(libav().av_malloc(kInputBufferBytes));
  if (buffer != nullptr) {
    io_ =
        libav().avio_alloc_context(buffer, kInputBufferBytes, 0, this, read_pipe, nullptr, nullptr);
  }
  if (io_ == nullptr) {
    libav().av_free(buffer);
    throw std::bad_alloc();
  }
}

int StreamInput::read_pipe(void* input, std::uint8_t* bytes, int size) {
  const auto& self = *static_cast<const StreamInput*>(input);
  // Of a named pipe the end comes after its first writer, not before.
  pollfd end{self.descriptor_, POLLIN, 0};
  while (!self.is_stopped()) {
    const int ready = ::poll(&end, 1, self.stop_ != nullptr ? kStopInterval_ms : -1);
    if (ready == 0 || (ready < 0 && errno == EINTR)) {
      continue;
    }
    const auto count = ::read(self.descriptor_, bytes, static_cast<std::size_t>(size));
    if (count > 0) {
      return static_cast<int>(count);
    }
    if (count == 0) {
      return AVERROR_EOF;
    }
    if (errno != EINTR && errno != EAGAIN) {
      return AVERROR(errno);
    }
  }
  return AVERROR_EXIT;
}

int StreamInput::is_over(void* input) {
  const auto& self = *static_cast<const StreamInput*>(input);
  return self.is_stopped() || std::chrono::steady_clock::now() > self.deadline_ ? 1 : 0;
}

void StreamInput::wait_at_most(std::chrono::seconds limit) {
  limit_ = limit;
  deadline_ = std::chrono::steady_clock::now() + limit;
}

void StreamInput::allow_silence() {
  if (is_of_network()) {
    wait_at_most(kSilence);
  }
}

std::string StreamInput::problem(int result) const {
  return std::chrono::steady_clock::now() > deadline_
             ? fmt::format("no answer within {} s", limit_.count())
             : libav_message(result);
}

void StreamInput::connect() {
  wait_at_most(kConnecting);
  AVDictionary* options = nullptr;
  libav().av_dict_set(&options, "protocol_whitelist", "tcp", 0);
  const AVIOInterruptCB callback = {is_over, this};
  const int result = libav().avio_open2(&io_, name_.c_str(), AVIO_FLAG_READ, &callback, &options);
  libav().av_dict_free(&options);
  if (is_stopped()) {
    throw scheduler::Interrupted();
  }
  if (result < 0) {
    fail(fmt::format("cannot be opened ({})", problem(result)));
  }
}

LibavInput StreamInput::open(const std::optional<RawVideoShape>& raw, FrameRate raw_rate) {
  const bool connects = io_ == nullptr;
  AVDictionary* options = nullptr;
  if (raw && kind_ != Kind::kRtsp) {
    set_shape(*raw, raw_rate, &options);
  }
  const AVInputFormat* format = nullptr;
  if (kind_ == Kind::kCamera) {
    register_cameras();
    format = libav().av_find_input_format("video4linux2");
  } else if (kind_ == Kind::kRtsp) {
    format = libav().av_find_input_format("rtsp");
    libav().av_dict_set(&options, "rtsp_flags", "prefer_tcp", 0);  // which loses nothing
  } else if (raw) {
    format = libav().av_find_input_format("rawvideo");
  }
  AVFormatContext* opened = libav().avformat_alloc_context();
  if (opened == nullptr) {
    libav().av_dict_free(&options);
    throw std::bad_alloc();
  }
  opened->pb = io_;
  opened->interrupt_callback = {is_over, this};
  limit_to_footage(*opened);
  if (format != nullptr) {  // what is no container is chosen here, not by its bytes
    libav().av_freep(&opened->format_whitelist);
  }
  opened->protocol_whitelist =
      libav().av_strdup(kind_ == Kind::kRtsp ? "rtsp,rtp,udp,tcp" : kNothing);
  // Rates are those that are stated: frames are not awaited to measure them.
  opened->fps_probe_size = 0;
  kind_ == Kind::kRtsp ? wait_at_most(kConnecting) : allow_silence();
  int result =
      libav().avformat_open_input(&opened, connects ? name_.c_str() : "", format, &options);
  libav().av_dict_free(&options);
  LibavInput input(result < 0 ? nullptr : opened);
  const AVStream* const stream = result < 0 ? nullptr : find_video_stream(*input);
  // Where the header says it all, nothing more is awaited.
  if (result >= 0 && (stream == nullptr || stream->codecpar->width == 0)) {
    allow_silence();
    result = libav().avformat_find_stream_info(input.get(), nullptr);
  }
  if (is_stopped()) {
    throw scheduler::Interrupted();
  }
  if (result < 0 && (connects || is_of_network())) {
    fail(fmt::format("cannot be opened ({})", problem(result)));
  }
  if (result < 0 || find_video_stream(*input) == nullptr) {
    fail(raw ? "is empty or no raw video"
             : "is empty or no video that can be streamed, such as y4m, MPEG-TS or Matroska; "
               "rawvideo needs `raw-video`");
  }
  return input;
}

}  // namespace vantage
