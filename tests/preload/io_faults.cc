// Preloaded into a program under test: ends it, or lets the disk fail or be full, at a chosen call
// on files below a folder. Which calls count does not depend on time, so tests can go through them
// one by one. Seen is what goes through the C library's functions below, as that of C++ streams and
// FFmpeg does; what its own streams (FILE) read and write is not. Environment:
//   IO_FAULTS_FOLDER  only files below it count
//   IO_FAULTS_KILL    number (from 1) of the call that changes files before which the process is
//                     killed
//   IO_FAULTS_FAIL    "NAME:N": the N-th call of that function fails with EIO. After fsync,
//                     fdatasync or close, half of what this descriptor had to flush is lost, and
//                     flushing again succeeds, as on Linux
//   IO_FAULTS_SPACE   bytes that can be written; then the disk is full
//   IO_FAULTS_SHORT   most bytes that a read or write moves; -1: one fewer than wanted
//   IO_FAULTS_COUNT   file that is written at the end: the number of calls, and then, a line each,
//                     what the first kMaxNamed of them were and how much they were to move
//                     ("write 120")

#include <sys/stat.h>
#include <sys/uio.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "tests/preload/file_calls.h"

namespace {

constexpr long kMaxNamed = 20000;
constexpr std::size_t kMaxDescriptors = 4096;

struct NotedCall {
  std::atomic<const char*> name;
  std::atomic<std::size_t> bytes;
};

// The calls come from C code anywhere in the process: there is nothing to hand a state through.
// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables)
std::atomic<long> calls{0};
std::atomic<long> changes{0};
std::atomic<long> of_failing_name{0};
std::atomic<long> written{0};
std::array<NotedCall, kMaxNamed> noted;
/// Bytes of an open file that are safe.
std::array<std::atomic<off_t>, kMaxDescriptors> flushed_bytes;
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

long number_in(const char* variable) {
  const char* text = std::getenv(variable);
  return text == nullptr ? 0 : std::atol(text);
}

bool is_below_folder(std::string_view path) {
  const char* folder = std::getenv("IO_FAULTS_FOLDER");
  return folder != nullptr && path.starts_with(folder);
}

bool is_named_to_fail(const char* name) {
  const char* wanted = std::getenv("IO_FAULTS_FAIL");
  const std::size_t length = std::strlen(name);
  return wanted != nullptr && std::strncmp(wanted, name, length) == 0 && wanted[length] == ':' &&
         ++of_failing_name == std::atol(wanted + length + 1);
}

bool is_full() {
  const char* space = std::getenv("IO_FAULTS_SPACE");
  return space != nullptr && written >= std::atol(space);
}

enum class Effect { kNone, kChange, kNeedsSpace };

/// Counts a call; true when it has to fail, with errno.
bool fails(const char* name, std::string_view path, Effect effect, std::size_t bytes = 0) {
  if (!is_below_folder(path)) {
    return false;
  }
  const long call = calls++;
  if (call < kMaxNamed) {
    noted[static_cast<std::size_t>(call)].name = name;
    noted[static_cast<std::size_t>(call)].bytes = bytes;
  }
  if (effect != Effect::kNone && ++changes == number_in("IO_FAULTS_KILL")) {
    std::raise(SIGKILL);
  }
  if (is_named_to_fail(name)) {
    errno = EIO;
    return true;
  }
  if (effect == Effect::kNeedsSpace && is_full()) {
    errno = ENOSPC;
    return true;
  }
  return false;
}

std::size_t place_of(int descriptor) {
  return std::min(static_cast<std::size_t>(std::max(descriptor, 0)), kMaxDescriptors - 1);
}

off_t size_of(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) ? status.st_size : 0;
}

/// fsync, fdatasync, close: `flush` does it.
template <typename Flush>
int flush_as(const char* name, int descriptor, Effect effect, const Flush& flush) {
  const std::string path = path_of(descriptor);
  const off_t bytes = size_of(descriptor);
  const bool is_failing = fails(name, path, effect);
  const bool is_close = effect == Effect::kNone;
  const bool is_written = (::fcntl(descriptor, F_GETFL) & O_ACCMODE) != O_RDONLY;
  std::atomic<off_t>& safe = flushed_bytes[place_of(descriptor)];
  if (is_failing && bytes > safe && (is_written || !is_close)) {
    (void)!::truncate(path.c_str(), safe + (bytes - safe) / 2);
  }
  if (!is_failing && !is_close) {
    safe = bytes;
  }
  const int error = errno;
  const int result = is_failing && !is_close ? -1 : flush();
  if (is_failing) {
    errno = error;
    return -1;
  }
  return result;
}

/// How much of what is to be moved is.
std::size_t moved(std::size_t bytes) {
  const long most = number_in("IO_FAULTS_SHORT");
  return most == 0 || bytes <= 1 ? bytes
         : most < 0              ? bytes - 1
                                 : std::min(bytes, static_cast<std::size_t>(most));
}

/// Write calls: `write` moves as many bytes as it is told.
template <typename Write>
ssize_t write_as(const char* name, int descriptor, std::size_t bytes, const Write& write) {
  const std::string path = path_of(descriptor);
  if (fails(name, path, Effect::kNeedsSpace, bytes)) {
    return -1;
  }
  if (!is_below_folder(path)) {
    return write(bytes);
  }
  std::size_t part = moved(bytes);
  const long before = written.fetch_add(static_cast<long>(part));
  if (std::getenv("IO_FAULTS_SPACE") != nullptr) {
    const long space = number_in("IO_FAULTS_SPACE") - before;
    part = std::min(part, static_cast<std::size_t>(std::max(space, 0L)));
    if (part == 0 && bytes > 0) {
      errno = ENOSPC;
      return -1;
    }
  }
  return write(part);
}

template <typename Read>
ssize_t read_as(const char* name, int descriptor, std::size_t bytes, const Read& read) {
  const std::string path = path_of(descriptor);
  if (fails(name, path, Effect::kNone)) {
    return -1;
  }
  return read(is_below_folder(path) ? moved(bytes) : bytes);
}

struct CountAtEnd {
  ~CountAtEnd() {
    if (const char* path = std::getenv("IO_FAULTS_COUNT")) {
      const long count = calls;
      if (std::FILE* file = std::fopen(path, "w")) {
        std::fprintf(file, "%ld\n", count);
        for (long call = 0; call < std::min(count, kMaxNamed); ++call) {
          const NotedCall& one = noted[static_cast<std::size_t>(call)];
          std::fprintf(file, "%s %zu\n", one.name.load(), one.bytes.load());
        }
        std::fclose(file);
      }
    }
  }
};
const CountAtEnd count_at_end;

}  // namespace

static int open_as(const char* name, const char* path, int flags, mode_t mode) {
  if ((flags & O_CREAT) != 0 && fails(name, path, Effect::kNeedsSpace)) {
    return -1;
  }
  const int descriptor = next<int(const char*, int, ...)>(name)(path, flags, mode);
  flushed_bytes[place_of(descriptor)] = (flags & O_ACCMODE) == O_RDONLY ? 0 : size_of(descriptor);
  return descriptor;
}

extern "C" {

ssize_t read(int descriptor, void* bytes, size_t size) {
  return read_as("read", descriptor, size, [&](size_t part) {
    return next<ssize_t(int, void*, size_t)>("read")(descriptor, bytes, part);
  });
}

ssize_t write(int descriptor, const void* bytes, size_t size) {
  return write_as("write", descriptor, size, [&](size_t part) {
    return next<ssize_t(int, const void*, size_t)>("write")(descriptor, bytes, part);
  });
}

ssize_t pwrite(int descriptor, const void* bytes, size_t size, off_t offset) {
  return write_as("pwrite", descriptor, size, [&](size_t part) {
    return next<ssize_t(int, const void*, size_t, off_t)>("pwrite")(descriptor, bytes, part,
                                                                    offset);
  });
}

/// Of standard streams: what is moved is its first part that is not empty, or the whole.
ssize_t writev(int descriptor, const iovec* parts, int count) {
  size_t size = 0;
  for (int i = 0; i < count; ++i) {
    size += parts[i].iov_len;
  }
  return write_as("writev", descriptor, size, [&](size_t wanted) {
    if (wanted == size) {
      return next<ssize_t(int, const iovec*, int)>("writev")(descriptor, parts, count);
    }
    const iovec* first =
        std::find_if(parts, parts + count, [](const iovec& part) { return part.iov_len > 0; });
    return next<ssize_t(int, const void*, size_t)>("write")(descriptor, first->iov_base,
                                                            std::min(wanted, first->iov_len));
  });
}

int close(int descriptor) {
  return flush_as("close", descriptor, Effect::kNone,
                  [&] { return next<int(int)>("close")(descriptor); });
}

int fsync(int descriptor) {
  return flush_as("fsync", descriptor, Effect::kChange,
                  [&] { return next<int(int)>("fsync")(descriptor); });
}

int fdatasync(int descriptor) {
  return flush_as("fdatasync", descriptor, Effect::kChange,
                  [&] { return next<int(int)>("fdatasync")(descriptor); });
}

int fallocate(int descriptor, int mode, off_t offset, off_t length) {
  const std::string path = path_of(descriptor);
  if (is_below_folder(path) && is_full()) {
    errno = ENOSPC;
    return -1;
  }
  return next<int(int, int, off_t, off_t)>("fallocate")(descriptor, mode, offset, length);
}

int ftruncate(int descriptor, off_t length) {
  return fails("ftruncate", path_of(descriptor), Effect::kChange)
             ? -1
             : next<int(int, off_t)>("ftruncate")(descriptor, length);
}

int rename(const char* from, const char* to) {
  return fails("rename", to, Effect::kChange)
             ? -1
             : next<int(const char*, const char*)>("rename")(from, to);
}

int link(const char* from, const char* to) {
  return fails("link", to, Effect::kNeedsSpace)
             ? -1
             : next<int(const char*, const char*)>("link")(from, to);
}

int remove(const char* path) {
  return fails("remove", path, Effect::kChange) ? -1 : next<int(const char*)>("remove")(path);
}

int unlinkat(int folder, const char* path, int flags) {
  return fails("unlinkat", path_of(folder), Effect::kChange)
             ? -1
             : next<int(int, const char*, int)>("unlinkat")(folder, path, flags);
}

int mkdir(const char* path, mode_t mode) {
  return fails("mkdir", path, Effect::kNeedsSpace)
             ? -1
             : next<int(const char*, mode_t)>("mkdir")(path, mode);
}

}  // extern "C"
