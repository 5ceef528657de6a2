#pragma once

#include <filesystem>

#include "engine/io/file_descriptor.h"

namespace vantage {

/// Has the file `path`, which must be there, for this process alone as long as the object lives.
/// File systems that know no locks do without.
class FileLock {
 public:
  /// Whether one waits for other processes or looks at is_held().
  enum class Wait { kNo, kYes };

  FileLock(const std::filesystem::path& path, Wait wait);

  /// False when another process has it.
  [[nodiscard]] bool is_held() const { return is_held_; }

 private:
  FileDescriptor file_;
  bool is_held_;
};

}  // namespace vantage
