#include "engine/io/video/remote_input.h"

#include <cstdio>
#include <new>

#include "engine/io/video/libav_functions.h"

namespace vantage {
namespace {

constexpr int kBufferBytes = 1 << 16;

}  // namespace

RemoteInput::RemoteInput(const std::filesystem::path& address)
    : file_(open_random_access(address)) {
  auto* const buffer = static_cast<unsigned char*>(libav().av_malloc(kBufferBytes));
  io_ = buffer == nullptr
            ? nullptr
            : libav().avio_alloc_context(buffer, kBufferBytes, 0, this, read, nullptr, seek);
  if (io_ == nullptr) {
    libav().av_free(buffer);
    throw std::bad_alloc();
  }
}

RemoteInput::~RemoteInput() {
  libav().av_freep(&io_->buffer);  // libav may have exchanged it
  libav().avio_context_free(&io_);
}

void RemoteInput::attach_to(AVFormatContext& input) {
  input.pb = io_;
  input.opaque = this;
}

void RemoteInput::rethrow() const {
  if (problem_ != nullptr) {
    std::rethrow_exception(problem_);
  }
}

int RemoteInput::read(void* self, std::uint8_t* bytes, int size) {
  auto& input = *static_cast<RemoteInput*>(self);
  try {
    const std::size_t count =
        input.file_->read(input.place_, {bytes, static_cast<std::size_t>(size)});
    input.place_ += count;
    return count == 0 ? AVERROR_EOF : static_cast<int>(count);
  } catch (...) {
    input.problem_ = std::current_exception();
    return AVERROR(EIO);
  }
}

std::int64_t RemoteInput::seek(void* self, std::int64_t offset, int origin) {
  auto& input = *static_cast<RemoteInput*>(self);
  const auto size = static_cast<std::int64_t>(input.file_->size());
  if ((origin & AVSEEK_SIZE) != 0) {
    return size;
  }
  const std::int64_t begin = origin == SEEK_CUR   ? static_cast<std::int64_t>(input.place_)
                             : origin == SEEK_END ? size
                                                  : 0;
  if (begin + offset < 0) {
    return AVERROR(EINVAL);
  }
  input.place_ = static_cast<std::uint64_t>(begin + offset);
  return begin + offset;
}

}  // namespace vantage
