#include "engine/io/video/standard_input.h"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <new>

#include "engine/io/video/libav_functions.h"

extern "C" {
#include <libavformat/avformat.h>
#include <libavutil/mem.h>
}

namespace vantage {
namespace {

constexpr int kInputBufferBytes = 1 << 16;
constexpr int kStopInterval_ms = 100;

}  // namespace

StandardInput::StandardInput(const std::atomic<bool>* stop) : stop_(stop) {
  auto* const buffer = static_cast<unsigned char*>(av_malloc(kInputBufferBytes));
  if (buffer != nullptr) {
    io_ = libav().avio_alloc_context(buffer, kInputBufferBytes, 0, this, read, nullptr, nullptr);
  }
  if (io_ == nullptr) {
    av_free(buffer);
    throw std::bad_alloc();
  }
}

StandardInput::~StandardInput() {
  av_freep(&io_->buffer);  // libav may have exchanged it
  libav().avio_context_free(&io_);
}

int StandardInput::read(void* input, std::uint8_t* bytes, int size) {
  const auto& self = *static_cast<const StandardInput*>(input);
  pollfd end{STDIN_FILENO, POLLIN, 0};
  while (!self.is_stopped()) {
    const int ready = ::poll(&end, 1, self.stop_ != nullptr ? kStopInterval_ms : -1);
    if (ready == 0 || (ready < 0 && errno == EINTR)) {
      continue;
    }
    const auto count = ::read(STDIN_FILENO, bytes, static_cast<std::size_t>(size));
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

}  // namespace vantage
