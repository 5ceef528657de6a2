#pragma once

// Files of cameras, made from plain ones: with an EXIF orientation, or several in one.
#include <cstdint>
#include <string>
#include <vector>

#include "engine/io/files/checksum.h"

namespace vantage {

inline std::string big(std::uint32_t value, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) {
    text.push_back(static_cast<char>(value >> (8 * i)));
  }
  return text;
}

/// EXIF data of one entry: Orientation.
inline std::string exif(int orientation) {
  return std::string("MM\0\x2A", 4) + big(8, 4) + big(1, 2) + big(274, 2) + big(3, 2) + big(1, 4) +
         big(static_cast<std::uint32_t>(orientation), 2) + std::string(6, '\0');
}

/// The file with another segment after its first marker.
inline std::string with_segment(const std::string& jpeg, int marker, const std::string& content) {
  return jpeg.substr(0, 2) + '\xFF' + static_cast<char>(marker) +
         big(static_cast<std::uint32_t>(content.size() + 2), 2) + content + jpeg.substr(2);
}

/// An MPO: JPEG files one after the other, the first with an index of all.
inline std::string mpo_of(const std::vector<std::string>& jpegs,
                          const std::vector<std::uint32_t>& types) {
  const auto index = [&](std::uint32_t first_size) {
    std::string text("MPF\0MM\0\x2A", 8);
    text += big(8, 4) + big(1, 2) + big(0xB002, 2) + big(7, 2) +
            big(static_cast<std::uint32_t>(16 * jpegs.size()), 4) + big(26, 4) + big(0, 4);
    std::uint32_t position = first_size;
    for (std::size_t i = 0; i < jpegs.size(); ++i) {
      const auto size = i == 0 ? first_size : static_cast<std::uint32_t>(jpegs[i].size());
      // Offsets are from the byte after "MPF\0", which is byte 10 of the file.
      text += big(types[i], 4) + big(size, 4) + big(i == 0 ? 0 : position - 10, 4) + big(0, 4);
      position += i == 0 ? 0 : size;
    }
    return text;
  };
  const auto first_size = static_cast<std::uint32_t>(with_segment(jpegs[0], 0xE2, index(0)).size());
  std::string file = with_segment(jpegs[0], 0xE2, index(first_size));
  for (std::size_t i = 1; i < jpegs.size(); ++i) {
    file += jpegs[i];
  }
  return file;
}

/// A PNG file with that orientation, after its header.
inline std::string with_exif_chunk(const std::string& png, int orientation) {
  constexpr std::size_t kAfterHeader = 33;
  const std::string chunk = "eXIf" + exif(orientation);
  const std::vector<std::uint8_t> checked(chunk.begin(), chunk.end());
  return png.substr(0, kAfterHeader) + big(static_cast<std::uint32_t>(chunk.size() - 4), 4) +
         chunk + big(crc32_of(checked), 4) + png.substr(kAfterHeader);
}

}  // namespace vantage
