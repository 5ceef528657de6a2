#pragma once

#include <filesystem>

#include "engine/io/files/file_descriptor.h"

namespace vantage {

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
