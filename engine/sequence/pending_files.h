#pragma once

#include <filesystem>
#include <functional>
#include <vector>

namespace vantage {

/// Files that are complete on disk but do not have their names yet: encoding and flushing can run
/// for several frames at once while the names appear in order. Thread rule: one thread at a time.
class PendingFiles {
 public:
  PendingFiles() = default;
  PendingFiles(PendingFiles&& other) noexcept = default;
  PendingFiles& operator=(PendingFiles&&) = delete;
  ~PendingFiles() { discard(); }

  /// Has `write` make the file under a hidden name beside `path`, with the same extension.
  void add(const std::filesystem::path& path,
           const std::function<void(const std::filesystem::path&)>& write);
  /// Gives all files their names, in the order of add(). Throws Error naming the one that failed.
  void commit();
  /// Removes what has no name yet.
  void discard() noexcept;

 private:
  struct File {
    std::filesystem::path hidden;
    std::filesystem::path path;
  };
  std::vector<File> files_;
};

}  // namespace vantage
