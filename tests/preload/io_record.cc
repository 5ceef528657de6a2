// Preloaded into a program under test: writes down, in order, what it does to files below a folder,
// with the bytes. Environment:
//   IO_RECORD_FOLDER  only files below it, an absolute path
//   IO_RECORD_LOG     the file to append to, which is elsewhere: records
//   "CALL\tPATH\tNUMBER\tSIZE\n"
//                     and then SIZE bytes. NUMBER is the offset of a write, or a length; the bytes
//                     of rename and link are the new name. Opening is recorded where it makes a
//                     file
//                     ("create") or empties it ("truncate").
// A lock is held during each call, so that the order of the records is that of the calls.

#include <sys/stat.h>
#include <sys/uio.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string>
#include <string_view>

#include "tests/preload/file_calls.h"

namespace {

std::mutex& recording() {
  static std::mutex mutex;
  return mutex;
}

bool is_recorded(std::string_view path) {
  static const char* const folder = std::getenv("IO_RECORD_FOLDER");
  return folder != nullptr && path.starts_with(folder);
}

void record(const char* call, const std::string& path, long number = 0,
            std::string_view bytes = {}) {
  static const int log = next<int(const char*, int, ...)>("open")(
      std::getenv("IO_RECORD_LOG"), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  std::string text = std::string(call) + '\t' + path + '\t' + std::to_string(number) + '\t' +
                     std::to_string(bytes.size()) + '\n';
  text += bytes;
  if (next<ssize_t(int, const void*, size_t)>("write")(log, text.data(), text.size()) !=
      static_cast<ssize_t>(text.size())) {
    std::abort();
  }
}

/// Calls `change`; records it if it succeeds.
template <typename Change>
int recorded(const char* call, const std::string& path, long number, std::string_view bytes,
             const Change& change) {
  if (!is_recorded(path)) {
    return change();
  }
  const std::lock_guard lock(recording());
  const int result = change();
  if (result == 0) {
    record(call, path, number, bytes);
  }
  return result;
}

template <typename Write>
ssize_t recorded_write(int descriptor, off_t offset, const char* bytes, const Write& write) {
  const std::string path = path_of(descriptor);
  if (!is_recorded(path)) {
    return write();
  }
  const std::lock_guard lock(recording());
  struct stat status {};
  if (offset < 0 && (::fcntl(descriptor, F_GETFL) & O_APPEND) != 0 &&
      ::fstat(descriptor, &status) == 0) {
    offset = status.st_size;
  } else if (offset < 0) {
    offset = ::lseek(descriptor, 0, SEEK_CUR);
  }
  const ssize_t written = write();
  if (written > 0) {
    record("write", path, offset, {bytes, static_cast<std::size_t>(written)});
  }
  return written;
}

}  // namespace

static int open_as(const char* name, const char* path, int flags, mode_t mode) {
  const auto open = [&] { return next<int(const char*, int, ...)>(name)(path, flags, mode); };
  if ((flags & (O_CREAT | O_TRUNC)) == 0 || !is_recorded(path)) {
    return open();
  }
  const std::lock_guard lock(recording());
  const bool is_new = ::access(path, F_OK) != 0;
  const int descriptor = open();
  if (descriptor >= 0 && (is_new || (flags & O_TRUNC) != 0)) {
    record(is_new ? "create" : "truncate", path);
  }
  return descriptor;
}

extern "C" {

ssize_t write(int descriptor, const void* bytes, size_t size) {
  return recorded_write(descriptor, -1, static_cast<const char*>(bytes), [&] {
    return next<ssize_t(int, const void*, size_t)>("write")(descriptor, bytes, size);
  });
}

ssize_t pwrite(int descriptor, const void* bytes, size_t size, off_t offset) {
  return recorded_write(descriptor, offset, static_cast<const char*>(bytes), [&] {
    return next<ssize_t(int, const void*, size_t, off_t)>("pwrite")(descriptor, bytes, size,
                                                                    offset);
  });
}

/// As several writes: no more is promised of it.
ssize_t writev(int descriptor, const iovec* parts, int count) {
  ssize_t sum = 0;
  for (int i = 0; i < count; ++i) {
    const ssize_t written = ::write(descriptor, parts[i].iov_base, parts[i].iov_len);
    if (written < 0) {
      return sum > 0 ? sum : written;
    }
    sum += written;
    if (static_cast<std::size_t>(written) < parts[i].iov_len) {
      break;
    }
  }
  return sum;
}

int fsync(int descriptor) {
  return recorded("fsync", path_of(descriptor), 0, {},
                  [&] { return next<int(int)>("fsync")(descriptor); });
}

int fdatasync(int descriptor) {
  return recorded("fsync", path_of(descriptor), 0, {},
                  [&] { return next<int(int)>("fdatasync")(descriptor); });
}

int ftruncate(int descriptor, off_t length) {
  return recorded("truncate", path_of(descriptor), length, {},
                  [&] { return next<int(int, off_t)>("ftruncate")(descriptor, length); });
}

int rename(const char* from, const char* to) {
  return recorded("rename", from, 0, to,
                  [&] { return next<int(const char*, const char*)>("rename")(from, to); });
}

int link(const char* from, const char* to) {
  return recorded("link", from, 0, to,
                  [&] { return next<int(const char*, const char*)>("link")(from, to); });
}

int remove(const char* path) {
  return recorded("remove", path, 0, {}, [&] { return next<int(const char*)>("remove")(path); });
}

int unlink(const char* path) {
  return recorded("remove", path, 0, {}, [&] { return next<int(const char*)>("unlink")(path); });
}

int rmdir(const char* path) {
  return recorded("remove", path, 0, {}, [&] { return next<int(const char*)>("rmdir")(path); });
}

int unlinkat(int folder, const char* path, int flags) {
  const std::string whole =
      folder == AT_FDCWD || path[0] == '/' ? std::string(path) : path_of(folder) + "/" + path;
  return recorded("remove", whole, 0, {}, [&] {
    return next<int(int, const char*, int)>("unlinkat")(folder, path, flags);
  });
}

int mkdir(const char* path, mode_t mode) {
  return recorded("mkdir", path, 0, {},
                  [&] { return next<int(const char*, mode_t)>("mkdir")(path, mode); });
}

}  // extern "C"
