// Preloaded into a program under test: ends it, or lets the disk be full, at a chosen call that
// changes files below a folder. Which calls count does not depend on time, so tests can go through
// them one by one. Environment:
//   IO_FAULTS_FOLDER  only files below it count
//   IO_FAULTS_KILL    number (from 1) of the call before which the process is killed
//   IO_FAULTS_FULL    number of the call from which on nothing can be written
//   IO_FAULTS_COUNT   file that is written at the end: the number of calls, and then, a line each,
//                     what the first kMaxNamed of them were ("rename")

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

// The calls come from C code anywhere in the process: there is nothing to hand a state through.
constexpr long kMaxNamed = 10000;
// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables)
std::atomic<long> calls{0};
std::array<std::atomic<const char*>, kMaxNamed> names;
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

long number_in(const char* variable) {
  const char* text = std::getenv(variable);
  return text == nullptr ? 0 : std::atol(text);
}

bool is_below_folder(const char* path) {
  const char* folder = std::getenv("IO_FAULTS_FOLDER");
  return folder != nullptr && std::strncmp(path, folder, std::strlen(folder)) == 0;
}

/// Counts a call; true when it has to fail because the disk is full.
bool fails(const char* name, const char* path, bool needs_space) {
  if (!is_below_folder(path)) {
    return false;
  }
  const long call = ++calls;
  if (call <= kMaxNamed) {
    names[static_cast<std::size_t>(call - 1)] = name;
  }
  if (call == number_in("IO_FAULTS_KILL")) {
    std::raise(SIGKILL);
  }
  const long full = number_in("IO_FAULTS_FULL");
  if (needs_space && full > 0 && call >= full) {
    errno = ENOSPC;
    return true;
  }
  return false;
}

bool fails(const char* name, int descriptor, bool needs_space) {
  char link[64];
  char path[4096];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t length = ::readlink(link, path, sizeof path - 1);
  if (length < 0) {
    return false;
  }
  path[length] = 0;
  return fails(name, path, needs_space);
}

template <typename Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

struct CountAtEnd {
  ~CountAtEnd() {
    if (const char* path = std::getenv("IO_FAULTS_COUNT")) {
      if (std::FILE* file = std::fopen(path, "w")) {
        std::fprintf(file, "%ld\n", calls.load());
        for (long call = 0; call < std::min(calls.load(), kMaxNamed); ++call) {
          std::fprintf(file, "%s\n", names[static_cast<std::size_t>(call)].load());
        }
        std::fclose(file);
      }
    }
  }
};
const CountAtEnd count_at_end;

/// open() or open64(), whichever `name` says; their mode comes third when there is one.
int open_as(const char* name, const char* path, int flags, va_list arguments) {
  const bool creates = (flags & O_CREAT) != 0;
  const mode_t mode = creates ? static_cast<mode_t>(va_arg(arguments, unsigned)) : 0;
  return creates && fails(name, path, true)
             ? -1
             : next<int(const char*, int, ...)>(name)(path, flags, mode);
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int descriptor = open_as("open", path, flags, arguments);
  va_end(arguments);
  return descriptor;
}

int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int descriptor = open_as("open64", path, flags, arguments);
  va_end(arguments);
  return descriptor;
}

ssize_t write(int descriptor, const void* bytes, size_t size) {
  return fails("write", descriptor, true)
             ? -1
             : next<ssize_t(int, const void*, size_t)>("write")(descriptor, bytes, size);
}

ssize_t writev(int descriptor, const iovec* parts, int count) {
  return fails("writev", descriptor, true)
             ? -1
             : next<ssize_t(int, const iovec*, int)>("writev")(descriptor, parts, count);
}

int fsync(int descriptor) {
  return fails("fsync", descriptor, false) ? -1 : next<int(int)>("fsync")(descriptor);
}

int fdatasync(int descriptor) {
  return fails("fdatasync", descriptor, false) ? -1 : next<int(int)>("fdatasync")(descriptor);
}

int ftruncate(int descriptor, off_t length) {
  return fails("ftruncate", descriptor, false)
             ? -1
             : next<int(int, off_t)>("ftruncate")(descriptor, length);
}

int rename(const char* from, const char* to) {
  return fails("rename", to, false) ? -1 : next<int(const char*, const char*)>("rename")(from, to);
}

int link(const char* from, const char* to) {
  return fails("link", to, true) ? -1 : next<int(const char*, const char*)>("link")(from, to);
}

int remove(const char* path) {
  return fails("remove", path, false) ? -1 : next<int(const char*)>("remove")(path);
}

int unlinkat(int folder, const char* path, int flags) {
  return fails("unlinkat", folder, false)
             ? -1
             : next<int(int, const char*, int)>("unlinkat")(folder, path, flags);
}

int mkdir(const char* path, mode_t mode) {
  return fails("mkdir", path, true) ? -1 : next<int(const char*, mode_t)>("mkdir")(path, mode);
}

}  // extern "C"
