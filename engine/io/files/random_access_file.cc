#include "engine/io/files/random_access_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "engine/error.h"
#include "engine/io/files/file_descriptor.h"
#include "engine/io/files/remote_files.h"

namespace vantage {
namespace {

class LocalFile final : public RandomAccessFile {
 public:
  explicit LocalFile(const std::filesystem::path& path)
      : path_(path), file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    struct stat status {};
    if (!file_.valid() || ::fstat(file_.get(), &status) != 0) {
      fail();
    }
    size_ = static_cast<std::uint64_t>(status.st_size);
  }

  [[nodiscard]] std::uint64_t size() const override { return size_; }

  std::size_t read(std::uint64_t offset, std::span<std::uint8_t> bytes) override {
    std::size_t filled = 0;
    while (filled < bytes.size()) {
      const ssize_t count = ::pread(file_.get(), bytes.data() + filled, bytes.size() - filled,
                                    static_cast<off_t>(offset + filled));
      if (count == 0) {
        break;
      }
      if (count < 0 && errno != EINTR) {
        fail();
      }
      filled += count < 0 ? 0 : static_cast<std::size_t>(count);
    }
    return filled;
  }

 private:
  [[noreturn]] void fail() const {
    throw Error(
        fmt::format("cannot read {}: {}", path_.string(), std::generic_category().message(errno)));
  }

  std::filesystem::path path_;
  FileDescriptor file_;
  std::uint64_t size_ = 0;
};

}  // namespace

std::unique_ptr<RandomAccessFile> open_random_access(const std::filesystem::path& file) {
  return is_address(file) ? remote_files(file).open(file.string())
                          : std::make_unique<LocalFile>(file);
}

}  // namespace vantage
