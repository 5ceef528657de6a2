#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace vantage {

/// CRC-32 as in PNG, gzip and zip, which common tools compute as well ("crc32 FILE").
std::uint32_t crc32_of(std::span<const std::uint8_t> bytes);

/// Size and checksum of a file as it is on disk.
struct FileContent {
  std::uint64_t bytes = 0;
  std::uint32_t crc32 = 0;
  friend bool operator==(const FileContent&, const FileContent&) = default;
};

/// Reads the whole file, in parts. Empty when that cannot be done.
std::optional<FileContent> file_content(const std::filesystem::path& file);

/// `object`, a JSON object as text, with the checksum of all that comes before it as its last
/// entry: "crc32": "00112233".
std::string with_checksum(std::string_view object);

/// Whether `text` is what with_checksum() gave; blanks at its end do not count.
bool has_valid_checksum(std::string_view text);

}  // namespace vantage
