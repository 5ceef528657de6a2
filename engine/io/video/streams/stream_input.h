#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "engine/io/video/frame_rate.h"
#include "engine/io/video/libav.h"
#include "engine/io/video/streams/raw_video_shape.h"

struct AVIOContext;

namespace vantage {

/// Where a stream comes from. Unlike libav's own inputs, it does not wait for data once `stop` is
/// set: a pipe may stay silent as long as it is open. Thread rule: one thread at a time.
class StreamInput {
 public:
  /// `name`: see is_stream_name(); `stop` may be null. A pipe is opened without waiting for who
  /// writes it; tcp:// is connected, within 10 s. So who fills two streams finds both open before
  /// either is read. Throws Error naming it, scheduler::Interrupted.
  StreamInput(std::string name, const std::atomic<bool>* stop);
  StreamInput(const StreamInput&) = delete;
  StreamInput& operator=(const StreamInput&) = delete;
  ~StreamInput();

  /// Opens its video: y4m, a container that can be streamed, or rawvideo of that shape; of a camera
  /// the shape asks for a mode. Waits for its start; for data of the network up to 60 s. The result
  /// reads this object. Call it once. Throws as the constructor.
  LibavInput open(const std::optional<RawVideoShape>& raw, FrameRate raw_rate);

  /// For messages: "standard input", the pipe, or the address without user and password.
  [[nodiscard]] const std::string& shown_name() const { return shown_name_; }
  [[nodiscard]] bool is_stopped() const { return stop_ != nullptr && stop_->load(); }
  /// Before each reading: the network may be silent for 60 s.
  void allow_silence();
  /// Why reading `result`, FFmpeg's code, failed.
  [[nodiscard]] std::string problem(int result) const;

 private:
  friend bool is_stream_name(const std::string& name);
  enum class Kind { kNone, kPipe, kCamera, kTcp, kRtsp };
  static Kind kind_of(const std::string& name);
  [[nodiscard]] bool is_of_network() const { return kind_ == Kind::kTcp || kind_ == Kind::kRtsp; }
  static int read_pipe(void* input, std::uint8_t* bytes, int size);
  /// Whether waiting is over, for libav.
  static int is_over(void* input);
  void wait_at_most(std::chrono::seconds limit);
  void open_pipe();
  void connect();
  [[noreturn]] void fail(const std::string& problem) const;

  std::string name_;
  Kind kind_ = kind_of(name_);
  std::string shown_name_;
  const std::atomic<bool>* stop_;
  int descriptor_ = -1;
  AVIOContext* io_ = nullptr;  ///< null where the demultiplexer connects
  std::chrono::seconds limit_{0};
  std::chrono::steady_clock::time_point deadline_ = std::chrono::steady_clock::time_point::max();
};

/// Whether `name` is read once, as it comes: "-" (standard input), a named pipe, a camera of Linux
/// (/dev/videoN), an address with tcp:// or rtsp://. Only such an address opens the network; what a
/// file or a stream names inside is never opened.
[[nodiscard]] inline bool is_stream_name(const std::string& name) {
  return StreamInput::kind_of(name) != StreamInput::Kind::kNone;
}

}  // namespace vantage
