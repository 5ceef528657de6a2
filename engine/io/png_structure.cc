#include "engine/io/png_structure.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <string>

namespace vantage {
namespace {

constexpr std::size_t kSignatureBytes = 8;

/// Deflate cannot compress by more than this factor.
constexpr std::size_t kMaxDeflateRatio = 1032;

constexpr std::array<std::uint32_t, 256> make_crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t n = 0; n < 256; ++n) {
    std::uint32_t c = n;
    for (int bit = 0; bit < 8; ++bit) {
      c = (c & 1U) != 0 ? 0xEDB88320U ^ (c >> 1) : c >> 1;
    }
    table[n] = c;
  }
  return table;
}
constexpr std::array<std::uint32_t, 256> kCrcTable = make_crc_table();

std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const std::uint8_t byte : bytes) {
    crc = kCrcTable[(crc ^ byte) & 255U] ^ (crc >> 8);
  }
  return ~crc;
}

/// Least number of bytes before compression, from the IHDR at `offset`.
std::size_t check_header(const FileBytes& file, std::size_t offset) {
  const auto width = file.integer<std::uint32_t>(offset, std::endian::big);
  const auto height = file.integer<std::uint32_t>(offset + 4, std::endian::big);
  file.check_dimensions(width, height);
  const int bit_depth = file.byte(offset + 8);
  const int colour_type = file.byte(offset + 9);
  constexpr std::array<int, 7> kChannels = {1, 0, 3, 1, 2, 0, 4};
  if (colour_type > 6 || kChannels[colour_type] == 0 || bit_depth < 1 || bit_depth > 16 ||
      !std::has_single_bit(static_cast<unsigned>(bit_depth))) {
    file.fail(fmt::format("its PNG header says colour type {} with {} bits, which does not exist",
                          colour_type, bit_depth));
  }
  const std::size_t row_bits =
      std::size_t{width} * static_cast<std::size_t>(kChannels[colour_type] * bit_depth);
  return (row_bits + 7) / 8 * height;
}

}  // namespace

std::vector<std::uint8_t> check_and_strip_png(const FileBytes& file) {
  std::vector<std::uint8_t> essential;
  essential.reserve(file.size());
  const auto signature = file.part(0, kSignatureBytes);
  essential.insert(essential.end(), signature.begin(), signature.end());

  std::size_t raw_bytes = 0;
  std::size_t compressed_bytes = 0;
  std::string type;
  for (std::size_t offset = kSignatureBytes; type != "IEND";) {
    const std::size_t length = file.integer<std::uint32_t>(offset, std::endian::big);
    const auto chunk = file.part(offset, length + 12);
    type.assign(chunk.begin() + 4, chunk.begin() + 8);
    if ((offset == kSignatureBytes) != (type == "IHDR") || (type == "IHDR" && length != 13)) {
      file.fail("is damaged, a PNG file begins with one IHDR chunk of 13 bytes");
    }
    const bool matters =
        type == "IHDR" || type == "PLTE" || type == "tRNS" || type == "IDAT" || type == "IEND";
    if (matters) {
      const auto stored = file.integer<std::uint32_t>(offset + 8 + length, std::endian::big);
      if (crc32(chunk.subspan(4, length + 4)) != stored) {
        file.fail(
            fmt::format("is damaged, wrong checksum of the {} chunk at byte {}", type, offset));
      }
      essential.insert(essential.end(), chunk.begin(), chunk.end());
    } else if (type[0] >= 'A' && type[0] <= 'Z') {
      file.fail(fmt::format("is damaged, unknown PNG chunk at byte {}", offset));
    }
    if (type == "IHDR") {
      raw_bytes = check_header(file, offset + 8);
    } else if (type == "IDAT") {
      compressed_bytes += length;
    }
    offset += chunk.size();
  }
  if (compressed_bytes == 0 || raw_bytes / kMaxDeflateRatio > compressed_bytes) {
    file.fail(fmt::format("is damaged, {} compressed bytes cannot hold the pixels its header says",
                          compressed_bytes));
  }
  return essential;
}

}  // namespace vantage
