#pragma once

#include <atomic>
#include <cstdint>

struct AVIOContext;

namespace vantage {

/// Standard input for libav's demuxers. Unlike libav's own, it does not wait for data once `stop`
/// is set: a pipe may stay silent as long as it is open. Thread rule: one thread at a time.
class StandardInput {
 public:
  /// `stop` may be null. Throws std::bad_alloc.
  explicit StandardInput(const std::atomic<bool>* stop);
  StandardInput(const StandardInput&) = delete;
  StandardInput& operator=(const StandardInput&) = delete;
  ~StandardInput();

  /// Lives as long as this object.
  [[nodiscard]] AVIOContext* io() const { return io_; }
  [[nodiscard]] bool is_stopped() const { return stop_ != nullptr && stop_->load(); }

 private:
  static int read(void* input, std::uint8_t* bytes, int size);

  const std::atomic<bool>* stop_;
  AVIOContext* io_ = nullptr;
};

}  // namespace vantage
