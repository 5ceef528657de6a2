#pragma once

#include <filesystem>

namespace vantage::apps {

/// A hidden folder for files that nobody wants, on the file system that they would be on; it goes
/// with this object.
class ThrowAwayFolder {
 public:
  /// In the nearest folder above `path` that is there. Throws Error when it cannot be made.
  explicit ThrowAwayFolder(const std::filesystem::path& path);
  ThrowAwayFolder(const ThrowAwayFolder&) = delete;
  ThrowAwayFolder& operator=(const ThrowAwayFolder&) = delete;
  ~ThrowAwayFolder();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Removes what is in it.
  void clear() const;

 private:
  std::filesystem::path path_;
};

}  // namespace vantage::apps
