// Photographs, as `match` reads them; each format is a target, for its seeds and words.
#include <libdeflate.h>

#include <cmath>
#include <variant>

#include "engine/io/files/checksum.h"
#include "engine/io/images/photograph_io.h"
#include "tests/fuzz/target.h"

namespace vantage::fuzz {
namespace {

void require_valid(const Photograph& photograph) {
  const int channels = photograph.channels();
  require(channels == 1 || channels == 3 || channels == 4, "channels");
  std::visit(
      [&](const auto& image) {
        for (int y = 0; y < image.height(); ++y) {
          for (int i = 0; i < image.width() * channels; ++i) {
            require(std::isfinite(static_cast<float>(image.row(y)[i])), "a finite value");
          }
        }
      },
      photograph.pixels);
}

/// The last byte of a file, which few formats read, chooses among the ways to read it.
void read_image(Bytes bytes) {
  PhotographReading reading;
  switch (bytes.empty() ? 0 : bytes.back() % 8) {
    case 1:
      reading.page = 1;
      break;
    case 2:
      reading.band = 2;
      break;
    case 3:
      reading.turns_upright = false;
      break;
    default:
      break;
  }
  require_valid(read_photograph(file_of(bytes), reading));
}

void put_big_endian(std::uint32_t value, std::vector<std::uint8_t>& bytes, std::size_t at) {
  for (int i = 0; i < 4; ++i) {
    bytes[at + static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
  }
}

/// Checksums of chunks are made right: else nothing behind them would be tried.
void read_png(Bytes given) {
  std::vector<std::uint8_t> bytes(given.begin(), given.end());
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    const std::uint32_t length = std::uint32_t{bytes[at]} << 24U | bytes[at + 1] << 16U |
                                 bytes[at + 2] << 8U | bytes[at + 3];
    if (length > bytes.size() - at - 12) {
      break;
    }
    put_big_endian(crc32_of(Bytes(bytes).subspan(at + 4, length + 4)), bytes, at + 8 + length);
    at += length + 12;
  }
  read_image(bytes);
}

void add_chunk(std::string_view name, Bytes content, std::vector<std::uint8_t>& png) {
  const std::size_t at = png.size();
  png.resize(at + 4);
  put_big_endian(static_cast<std::uint32_t>(content.size()), png, at);
  png.insert(png.end(), name.begin(), name.end());
  png.insert(png.end(), content.begin(), content.end());
  png.resize(png.size() + 4);
}

/// A PNG file of a header and filtered rows, which are compressed here: what is behind zlib.
void read_png_rows(Bytes bytes) {
  Values values(bytes);
  std::vector<std::uint8_t> header(13);
  header[3] = static_cast<std::uint8_t>(values.between(1, 40));
  header[7] = static_cast<std::uint8_t>(values.between(1, 40));
  header[8] = static_cast<std::uint8_t>(1U << static_cast<unsigned>(values.between(0, 4)));
  header[9] = static_cast<std::uint8_t>(values.between(0, 6));
  header[12] = static_cast<std::uint8_t>(values.between(0, 1));
  const int palette = values.between(0, 12);
  const Bytes rows = values.rest();
  static libdeflate_compressor* const compressor = libdeflate_alloc_compressor(1);
  std::vector<std::uint8_t> packed(libdeflate_zlib_compress_bound(compressor, rows.size()));
  packed.resize(
      libdeflate_zlib_compress(compressor, rows.data(), rows.size(), packed.data(), packed.size()));
  std::vector<std::uint8_t> png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  add_chunk("IHDR", header, png);
  if (palette > 0) {
    add_chunk("PLTE", std::vector<std::uint8_t>(static_cast<std::size_t>(3 * palette), 7), png);
    add_chunk("tRNS", std::vector<std::uint8_t>(static_cast<std::size_t>(palette), 9), png);
  }
  add_chunk("IDAT", packed, png);
  add_chunk("IEND", {}, png);
  read_png(png);
}

const Registration kTiff("tiff", read_image);
const Registration kJpeg("jpeg", read_image);
const Registration kPnm("pnm", read_image);
const Registration kPicture("picture", read_image);  // by OpenCV: BMP, WebP, EXR, JPEG 2000
const Registration kPng("png", read_png);
const Registration kPngRows("png_rows", read_png_rows);

}  // namespace
}  // namespace vantage::fuzz
