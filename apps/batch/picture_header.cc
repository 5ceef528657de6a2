#include "apps/batch/picture_header.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/error.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/files/random_access_file.h"

namespace vantage::apps {
namespace {

constexpr std::size_t kStart = 1 << 16;  // of a JPEG, segments come before the frame

int number_at(const FileBytes& bytes, std::size_t place) {
  return bytes.integer<std::uint16_t>(place, std::endian::big);
}

/// From the segment of the frame: SOF0 to SOF15 without DHT, JPG and DAC.
std::optional<PictureHeader> header_of_jpeg(const FileBytes& bytes) {
  std::size_t place = 2;
  while (bytes.byte(place) == 0xFF) {
    const int marker = bytes.byte(place + 1);
    if (marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC) {
      return PictureHeader{number_at(bytes, place + 7), number_at(bytes, place + 5),
                           bytes.byte(place + 4)};
    }
    place += 2 + static_cast<std::size_t>(number_at(bytes, place + 2));
  }
  return std::nullopt;
}

}  // namespace

std::optional<PictureHeader> read_picture_header(const std::filesystem::path& file) {
  try {
    const std::unique_ptr<RandomAccessFile> opened = open_random_access(file);
    std::vector<std::uint8_t> start(kStart);
    start.resize(opened->read(0, start));
    const FileBytes bytes(start, file.string());
    if (bytes.has_at(0, "\x89PNG\r\n\x1A\n")) {
      constexpr std::size_t kHeader = 16;  // of IHDR, whose upper halves are 0
      return PictureHeader{number_at(bytes, kHeader + 2), number_at(bytes, kHeader + 6),
                           bytes.byte(kHeader + 8)};
    }
    return bytes.has_at(0, "\xFF\xD8\xFF") ? header_of_jpeg(bytes) : std::nullopt;
  } catch (const Error&) {
    return std::nullopt;  // who opens it will say so
  }
}

}  // namespace vantage::apps
