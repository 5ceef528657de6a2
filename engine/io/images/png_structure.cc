#include "engine/io/images/png_structure.h"

#include <fmt/format.h>
#include <libdeflate.h>

#include <array>
#include <bit>
#include <string>

namespace vantage {
namespace {

constexpr std::array<std::uint8_t, 8> kSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};

/// Maximum compression factor of Deflate.
constexpr std::size_t kMaxDeflateRatio = 1032;

/// Reads the IHDR at `offset`; returns the minimum number of bytes before compression.
std::size_t read_header(const FileBytes& file, std::size_t offset, PngStructure& structure) {
  const auto width = file.integer<std::uint32_t>(offset, std::endian::big);
  const auto height = file.integer<std::uint32_t>(offset + 4, std::endian::big);
  file.check_dimensions(width, height);
  const int bit_depth = file.byte(offset + 8);
  const int colour_type = file.byte(offset + 9);
  constexpr std::array<int, 7> kChannels = {1, 0, 3, 1, 2, 0, 4};
  if (colour_type > 6 || kChannels[colour_type] == 0 || bit_depth < 1 || bit_depth > 16 ||
      !std::has_single_bit(static_cast<unsigned>(bit_depth))) {
    file.fail(fmt::format("its PNG header has colour type {} with {} bits, which does not exist",
                          colour_type, bit_depth));
  }
  structure.width = static_cast<int>(width);
  structure.height = static_cast<int>(height);
  structure.bit_depth = bit_depth;
  structure.colour_type = colour_type;
  structure.interlaced = file.byte(offset + 12) != 0;
  const std::size_t row_bits =
      std::size_t{width} * static_cast<std::size_t>(kChannels[colour_type] * bit_depth);
  return (row_bits + 7) / 8 * height;
}

}  // namespace

PngStructure check_png_structure(const FileBytes& file) {
  PngStructure structure;
  (void)file.part(0, kSignature.size());
  std::size_t raw_bytes = 0;
  std::size_t compressed_bytes = 0;
  std::string type;
  for (std::size_t offset = kSignature.size(); type != "IEND";) {
    const std::size_t length = file.integer<std::uint32_t>(offset, std::endian::big);
    const auto chunk = file.part(offset, length + 12);
    type.assign(chunk.begin() + 4, chunk.begin() + 8);
    if ((offset == kSignature.size()) != (type == "IHDR") || (type == "IHDR" && length != 13)) {
      file.fail("is damaged, expected one IHDR chunk of 13 bytes at its start");
    }
    const bool matters =
        type == "IHDR" || type == "PLTE" || type == "tRNS" || type == "IDAT" || type == "IEND";
    if (matters) {
      const auto stored = file.integer<std::uint32_t>(offset + 8 + length, std::endian::big);
      if (libdeflate_crc32(0, chunk.data() + 4, length + 4) != stored) {
        file.fail(
            fmt::format("is damaged, wrong checksum of the {} chunk at byte {}", type, offset));
      }
      structure.essential_chunks.push_back(chunk);
    } else if (type[0] >= 'A' && type[0] <= 'Z') {
      file.fail(fmt::format("is damaged, unknown PNG chunk at byte {}", offset));
    }
    if (type == "IHDR") {
      raw_bytes = read_header(file, offset + 8, structure);
    } else if (type == "IDAT") {
      compressed_bytes += length;
      structure.pixel_data.push_back(chunk.subspan(8, length));
    } else if (type == "tRNS") {
      structure.has_transparent_colour = true;
    }
    offset += chunk.size();
  }
  if (compressed_bytes == 0 || raw_bytes / kMaxDeflateRatio > compressed_bytes) {
    file.fail(fmt::format("is damaged, {} compressed bytes cannot hold the pixels of its header",
                          compressed_bytes));
  }
  return structure;
}

std::vector<std::uint8_t> strip_png(const PngStructure& structure) {
  std::vector<std::uint8_t> file(kSignature.begin(), kSignature.end());
  for (const auto chunk : structure.essential_chunks) {
    file.insert(file.end(), chunk.begin(), chunk.end());
  }
  return file;
}

}  // namespace vantage
