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

/// Reads the whole file, in parts. Empty if that fails.
std::optional<FileContent> file_content(const std::filesystem::path& file);

/// Appends to `object`, a JSON object as text, the checksum of everything before it: "crc32":
/// "00112233".
std::string with_checksum(std::string_view object);

/// Whether `text` is the unchanged output of with_checksum(), except for blanks at its end.
bool has_valid_checksum(std::string_view text);

}  // namespace vantage
