#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <set>
#include <span>
#include <vector>

#include "engine/error.h"

namespace vantage {

/// A result cannot be written. It is not the fault of its frame, so no frame is skipped for it.
class OutputError : public Error {
 public:
  using Error::Error;
};

/// Files that are written but do not have their final names yet: several frames are encoded at
/// once, while names appear in order and only for files that are safely on disk. Files that never
/// get their names are removed. Thread rule: one thread at a time.
class PendingFiles {
 public:
  PendingFiles() = default;
  PendingFiles(PendingFiles&& other) noexcept = default;
  PendingFiles& operator=(PendingFiles&& other) noexcept;
  ~PendingFiles() { discard(); }

  /// Writes `bytes` under a hidden name next to `path`. Throws OutputError naming `path`.
  void add(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

  [[nodiscard]] std::size_t count() const { return files_.size(); }
  /// Flushes file `index` to disk; commit() reports a failure. Flushing several at a time takes
  /// little longer than one. Thread rule: concurrently for different files.
  void flush(std::size_t index) noexcept;

  /// Flushes the files not flushed yet and gives all files their names, in the order of add(). The
  /// names are durable once the folders, which are added to `folders`, are flushed. Throws
  /// OutputError naming the file that failed.
  void commit(std::set<std::filesystem::path>& folders);

  /// Removes the files without a final name.
  void discard() noexcept;

 private:
  struct File {
    std::filesystem::path hidden;
    std::filesystem::path path;
    bool is_flushed = false;
    int flush_error = 0;  ///< errno, 0: none
  };
  std::vector<File> files_;
};

}  // namespace vantage
