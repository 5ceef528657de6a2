#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace vantage {

/// CRC-32 as in PNG, gzip and zip, also computed by common tools ("crc32 FILE").
std::uint32_t crc32_of(std::span<const std::uint8_t> bytes);

/// Size and checksum of a file on disk.
struct FileContent {
  std::uint64_t bytes = 0;
  std::uint32_t crc32 = 0;
  friend bool operator==(const FileContent&, const FileContent&) = default;
};

/// Reads the whole file, in parts. Empty if that fails, or it is no regular file.
std::optional<FileContent> file_content(const std::filesystem::path& file);

/// Appends to `object`, a JSON object as text, the checksum of everything before it: "crc32":
/// "00112233".
std::string with_checksum(std::string_view object);

/// Whether `text` is the unchanged output of with_checksum(), except for blanks at its end.
bool has_valid_checksum(std::string_view text);

/// 64-bit FNV-1a hash of bytes in the order in which they are added. Equal on every machine.
class Fnv1aHash {
 public:
  void add(std::string_view bytes);
  /// As eight bytes, least significant first.
  void add(std::uint64_t value);
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

/// Detects changed files without reading them: by their number, their bytes, and a hash over name,
/// size and modification time (at an address: ETag) of each, in order.
class FileIdentity {
 public:
  /// Adds a file under `name` (machines may see it at different paths). A missing file is hashed as
  /// missing.
  void add(std::string_view name, const std::filesystem::path& file);

  /// "2 files, 1234 bytes, hash 00112233445566ff"; missing files are not counted.
  [[nodiscard]] std::string to_string() const;

 private:
  int files_ = 0;
  std::uint64_t bytes_ = 0;
  Fnv1aHash hash_;
};

}  // namespace vantage
