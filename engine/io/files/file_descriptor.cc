#include "engine/io/files/file_descriptor.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "engine/error.h"

namespace vantage {

bool write_all(int descriptor, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) {
      return false;
    }
    bytes = bytes.subspan(static_cast<std::size_t>(std::max<ssize_t>(written, 0)));
  }
  return true;
}

bool write_all_at(int descriptor, std::size_t offset, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written =
        ::pwrite(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno != EINTR) {
      return false;
    }
    const auto done = static_cast<std::size_t>(std::max<ssize_t>(written, 0));
    bytes = bytes.subspan(done);
    offset += done;
  }
  return true;
}

void flush_folder(const std::filesystem::path& folder) {
  const FileDescriptor open_folder(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (open_folder.valid() && ::fsync(open_folder.get()) != 0 && errno != EINVAL &&
      errno != ENOTSUP && errno != EROFS) {
    throw Error(fmt::format("cannot write {}: {}", folder.string(),
                            std::generic_category().message(errno)));
  }
}

FileLock::FileLock(const std::filesystem::path& path, Wait wait)
    : file_(::open(path.c_str(), O_RDWR | O_CLOEXEC)) {
  int result = 0;
  do {
    result = ::flock(file_.get(), LOCK_EX | (wait == Wait::kNo ? LOCK_NB : 0));
  } while (result != 0 && errno == EINTR);
  is_held_ = result == 0 || errno != EWOULDBLOCK;
}

}  // namespace vantage
