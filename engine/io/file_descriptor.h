#pragma once

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <utility>

namespace vantage {

/// Closes a file of the operating system when it goes. Owns it.
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
  [[nodiscard]] int get() const { return descriptor_; }
  [[nodiscard]] bool valid() const { return descriptor_ >= 0; }

 private:
  int descriptor_;
};

/// False when that fails; errno then tells why.
bool write_all(int descriptor, std::span<const std::uint8_t> bytes);

/// Makes names in `folder` survive a power cut, where the file system can do that.
void flush_folder(const std::filesystem::path& folder);

}  // namespace vantage
