#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace vantage {

/// A file that appears under its final name whole or not at all. Whatever writes it writes to
/// temporary_path(), which is in the same folder, hidden and ends in the same extension; commit()
/// flushes and renames. Without commit() nothing is left. An existing file is replaced only by
/// commit(). Thread rule: one thread at a time; different objects may have the same final name
/// (the last commit wins).
class AtomicFile {
 public:
  /// Creates the empty temporary file. Throws Error when the folder is missing or not writable, or
  /// when `path` is there and is not a regular file. A link is followed, also one to a file that is
  /// not there yet.
  explicit AtomicFile(const std::filesystem::path& path);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  [[nodiscard]] const std::filesystem::path& temporary_path() const { return temporary_path_; }

  /// Flushes the temporary file to disk and gives it its final name. Call it once, after whatever
  /// wrote the file has closed it. Throws Error (a full disk, say).
  void commit();

  /// commit() unless something has the final name already, which then stays; false in that case,
  /// also when the temporary file has been cleared away since. Of several processes one succeeds;
  /// where the file system has no links, two at the very same moment may both do.
  bool commit_if_absent();

 private:
  /// 0 or what went wrong.
  [[nodiscard]] int flush() const;
  void flush_name() const;

  std::filesystem::path given_path_;  ///< as the caller wrote it, for messages
  std::filesystem::path final_path_;
  std::filesystem::path temporary_path_;
  bool committed_ = false;
};

/// What `path` leads to where it is a link, else itself. Links in circles stay as they are.
std::filesystem::path behind_links(const std::filesystem::path& path);

/// Writes `bytes` as the file `path`; whole or not at all. Throws Error.
void write_binary_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

/// Writes `text` as the file `path`; whole or not at all. Throws Error.
void write_text_file(const std::filesystem::path& path, std::string_view text);

/// write_text_file() unless there is such a file, which then stays as it is; false in that case.
bool create_text_file(const std::filesystem::path& path, std::string_view text);

}  // namespace vantage
