#pragma once

#include <filesystem>

namespace vantage::apps {

/// A hidden scratch folder on the file system of a path, removed with this object.
class ScratchFolder {
 public:
  /// In the nearest folder above `path` that is there. Throws Error when it cannot be made.
  explicit ScratchFolder(const std::filesystem::path& path);
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Removes what is in it.
  void clear() const;

 private:
  std::filesystem::path path_;
};

}  // namespace vantage::apps
