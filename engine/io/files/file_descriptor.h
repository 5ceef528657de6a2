#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <utility>

namespace vantage {

/// Owns a file descriptor and closes it on destruction.
class FileDescriptor {
 public:
  explicit FileDescriptor(int descriptor) : descriptor_(descriptor) {}
  FileDescriptor(FileDescriptor&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)) {}
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  ~FileDescriptor() {
    if (descriptor_ >= 0) {
      ::close(descriptor_);
    }
  }
  /// False on failure, with errno set: some file systems write only now, and what they then could
  /// not write no later flush tells.
  [[nodiscard]] bool close() { return ::close(std::exchange(descriptor_, -1)) == 0; }
  [[nodiscard]] int get() const { return descriptor_; }
  [[nodiscard]] bool valid() const { return descriptor_ >= 0; }

 private:
  int descriptor_;
};

/// False on failure, with errno set.
bool write_all(int descriptor, std::span<const std::uint8_t> bytes);

/// The same from byte `offset` of a file on; threads may write different parts at a time.
bool write_all_at(int descriptor, std::size_t offset, std::span<const std::uint8_t> bytes);

/// Makes names in `folder` durable across a power cut, if the file system supports it. Throws Error
/// naming the folder where the disk fails.
void flush_folder(const std::filesystem::path& folder);

/// Holds an exclusive lock on the existing file `path` for the lifetime of the object. Has no
/// effect on file systems without locks.
class FileLock {
 public:
  /// Whether to wait for other processes; otherwise see is_held().
  enum class Wait { kNo, kYes };

  FileLock(const std::filesystem::path& path, Wait wait);

  /// False when another process holds it.
  [[nodiscard]] bool is_held() const { return is_held_; }

 private:
  FileDescriptor file_;
  bool is_held_;
};

}  // namespace vantage
