#include "engine/io/video/writing/stream_output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>

#include "engine/error.h"
#include "scheduler/interruption.h"

namespace vantage {
namespace {

constexpr std::chrono::milliseconds kStopInterval{100};

mode_t mode_of(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 ? status.st_mode : 0;
}

/// Processes that share an open pipe share its O_NONBLOCK flag too. The pipe is opened a second
/// time, so that only this program sees the flag.
FileDescriptor reopened(int descriptor) {
  if (!S_ISFIFO(mode_of(descriptor))) {
    return FileDescriptor(-1);
  }
  const std::string name = fmt::format("/proc/self/fd/{}", descriptor);
  return FileDescriptor(::open(name.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC));
}

}  // namespace

StreamOutput::StreamOutput(int descriptor, const std::atomic<bool>* stop)
    : reopened_(reopened(descriptor)),
      descriptor_(reopened_.valid() ? reopened_.get() : descriptor),
      is_socket_(S_ISSOCK(mode_of(descriptor))),
      stop_(stop) {}

void StreamOutput::await_reader() {
  pollfd end{descriptor_, POLLOUT, 0};
  std::chrono::milliseconds waited{0};
  for (;;) {
    const int ready = ::poll(&end, 1, static_cast<int>(kStopInterval.count()));
    if (ready > 0) {
      return;
    }
    if (stop_ != nullptr && stop_->load() && (waited += kStopInterval) >= kPatience) {
      throw scheduler::Interrupted();
    }
  }
}

void StreamOutput::put(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t count =
        is_socket_ ? ::send(descriptor_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL)
                   : ::write(descriptor_, bytes.data(), bytes.size());
    if (count >= 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(count));
    } else if (errno == EAGAIN) {
      await_reader();
    } else if (errno != EINTR) {
      throw Error(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
    }
  }
}

}  // namespace vantage
