#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace vantage {

/// Throws Error for an errno.
[[noreturn]] void fail_to_write(const std::filesystem::path& path, int error_number);

/// Target of `path` if it is a link, else itself. Circular links are returned unchanged.
std::filesystem::path through_links(const std::filesystem::path& path);

/// A file that appears under its final name complete or not at all. The caller writes to
/// temporary_path(), a hidden file in the same folder with the same extension; commit() flushes and
/// renames. Without commit() nothing is left. An existing file is replaced only by commit(). At an
/// address, the hidden file is in the folder of temporary files ($TMPDIR), and commit() stores it.
/// Thread rule: one thread at a time; different objects may have the same final name (the last
/// commit wins).
class AtomicFile {
 public:
  /// Creates the empty temporary file. Throws Error when the folder is missing or not writable, or
  /// when `path` exists and is not a regular file. Links are followed, also to a missing file.
  explicit AtomicFile(const std::filesystem::path& path);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  [[nodiscard]] const std::filesystem::path& temporary_path() const { return temporary_path_; }

  /// Another final name in the same folder, before commit().
  void rename(const std::filesystem::path& path) {
    given_path_ = path;
    final_path_ = through_links(path);
  }

  /// Flushes the temporary file to disk and gives it its final name. Call it once, after the file
  /// has been closed. Throws Error (a full disk, say).
  void commit();

  /// commit() unless a file of the final name exists, which is then kept; false in that case, also
  /// when the temporary file has been removed since. Of several processes one succeeds; on a file
  /// system without links, two at the same moment may both succeed.
  bool commit_if_absent();

 private:
  void create_temporary(const std::filesystem::path& folder);
  /// 0 or errno.
  [[nodiscard]] int flush() const;
  void flush_name() const;

  std::filesystem::path given_path_;  ///< as given by the caller, for messages
  std::filesystem::path final_path_;
  std::filesystem::path temporary_path_;
  bool committed_ = false;
};

/// Writes `bytes` to the file `path` atomically. Throws Error.
void write_binary_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

/// Writes `text` to the file `path` atomically. Throws Error.
void write_text_file(const std::filesystem::path& path, std::string_view text);

/// write_text_file() unless the file exists, which is then kept; false in that case.
bool create_text_file(const std::filesystem::path& path, std::string_view text);

}  // namespace vantage
