#include "engine/io/files/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>

#include <cerrno>

namespace vantage {

FileLock::FileLock(const std::filesystem::path& path, Wait wait)
    : file_(::open(path.c_str(), O_RDWR | O_CLOEXEC)) {
  is_held_ = ::flock(file_.get(), LOCK_EX | (wait == Wait::kNo ? LOCK_NB : 0)) == 0 ||
             errno != EWOULDBLOCK;
}

}  // namespace vantage
