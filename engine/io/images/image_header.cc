#include "engine/io/images/image_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include "engine/io/images/exif.h"

namespace vantage {
namespace {

constexpr std::endian kLittle = std::endian::little;
constexpr std::endian kBig = std::endian::big;

/// Two bytes of a run are at most 255 pixels.
constexpr long long kMaxRunPixelsPerByte = 128;
/// Each 8×8 block takes at least one bit of Huffman code. Doubled, because components may be
/// subsampled.
constexpr long long kMaxJpegPixelsPerByte = 1024;
/// Arithmetic code has no such minimum; this is far beyond what photographs reach.
constexpr long long kMaxArithmeticPixelsPerByte = 65536;

/// Checked before allocation: a few bytes must not allocate gigabytes. `min_bytes`: what an image
/// takes at least.
void check_holds_pixels(const FileBytes& file, long long width, long long height,
                        long long min_bytes) {
  if (min_bytes > static_cast<long long>(file.size())) {
    file.fail(fmt::format("is damaged, {} bytes cannot hold the {}x{} pixels of its header",
                          file.size(), width, height));
  }
}

void check_bmp(const FileBytes& file) {
  const auto header_bytes = file.integer<std::uint32_t>(14, kLittle);
  if (header_bytes == 12) {
    file.check_dimensions(file.integer<std::uint16_t>(18, kLittle),
                          file.integer<std::uint16_t>(20, kLittle));
    return;
  }
  const long long width = static_cast<std::int32_t>(file.integer<std::uint32_t>(18, kLittle));
  // A negative height means rows from top to bottom.
  const long long height =
      std::llabs(static_cast<std::int32_t>(file.integer<std::uint32_t>(22, kLittle)));
  file.check_dimensions(width, height);
  const long long bits = file.integer<std::uint16_t>(28, kLittle);
  if (bits > 32) {
    file.fail(fmt::format("its BMP header says {} bits per pixel, expected at most 32", bits));
  }
  const auto compression = file.integer<std::uint32_t>(30, kLittle);
  if (compression == 0 || compression == 3) {
    const long long row_bytes = (width * bits + 31) / 32 * 4;
    (void)file.part(file.integer<std::uint32_t>(10, kLittle),
                    static_cast<std::size_t>(row_bytes * height));
  } else {
    check_holds_pixels(file, width, height, width * height / kMaxRunPixelsPerByte);
  }
}

bool is_start_of_frame(int marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

bool is_huffman_frame(int marker) { return marker <= 0xC7; }

/// Looks for the end marker first, because "is truncated" is clearer than a decoder's message.
/// Segments are skipped: a thumbnail in one has its own markers.
Orientation check_jpeg(const FileBytes& file) {
  const auto bytes = file.all();
  Orientation orientation = Orientation::kAsStored;
  bool has_frame = false;
  bool has_scan = false;
  std::size_t offset = 2;
  while (true) {
    const auto next = std::find(bytes.begin() + static_cast<std::ptrdiff_t>(offset), bytes.end(),
                                std::uint8_t{0xFF});
    offset = static_cast<std::size_t>(next - bytes.begin()) + 1;
    const int marker = file.byte(offset);
    // 00: a data byte FF; FF: padding; D0..D7 and 01: markers without a segment.
    if (marker == 0x00 || marker == 0x01 || marker == 0xFF || (marker >= 0xD0 && marker <= 0xD8)) {
      offset += marker == 0xFF ? 0 : 1;
      continue;
    }
    if (marker == 0xD9) {
      break;
    }
    const std::size_t length = file.integer<std::uint16_t>(offset + 1, kBig);
    const auto segment = file.part(offset + 1, length);
    constexpr std::string_view kExif("Exif\0\0", 6);
    if (marker == 0xE1 && length > 8 && file.has_at(offset + 3, kExif)) {
      orientation = exif_orientation(segment.subspan(8));
    }
    if (is_start_of_frame(marker)) {
      const int width = file.integer<std::uint16_t>(offset + 6, kBig);
      const int height = file.integer<std::uint16_t>(offset + 4, kBig);
      file.check_dimensions(width, height);
      check_holds_pixels(
          file, width, height,
          static_cast<long long>(width) * height /
              (is_huffman_frame(marker) ? kMaxJpegPixelsPerByte : kMaxArithmeticPixelsPerByte));
      has_frame = true;
    }
    has_scan = has_scan || marker == 0xDA;
    offset += 1 + length;
  }
  if (!has_frame || !has_scan) {
    file.fail("is damaged, expected a JPEG frame header and a scan");
  }
  return orientation;
}

/// Bytes that a byte of TIFF data can stand for; empty: no limit is known.
std::optional<long long> max_tiff_bytes_per_byte(int compression, long long pixel_bytes) {
  switch (compression) {
    case 1:  // none
      return 1;
    case 5:  // LZW: codes of 12 bits for strings of at most 3838 bytes
      return 2559;
    case 7:
      return kMaxJpegPixelsPerByte * pixel_bytes;
    case 8:
    case 32946:  // deflate
      return 1032;
    case 32773:  // PackBits: two bytes for a run of at most 128
      return 64;
    default:
      return std::nullopt;
  }
}

/// The first directory of a classic TIFF file. libtiff checks what it reads itself. Returns what
/// the file states as white: WhiteLevel (of DNG), else 2ⁿ − 1 of the bits of MaxSampleValue.
/// Decoders scale 10, 12 and 14 bits to 16.
StatedByFile check_tiff(const FileBytes& file) {
  const std::endian order = file.has_at(0, "II") ? kLittle : kBig;
  if (file.integer<std::uint16_t>(2, order) != 42) {
    file.fail("is a BigTIFF file, expected classic TIFF");
  }
  const std::size_t directory = file.integer<std::uint32_t>(4, order);
  const int entries = file.integer<std::uint16_t>(directory, order);
  long long width = 0;
  long long height = 0;
  long long samples = 1;
  long long bits = 1;
  int compression = 1;
  bool is_subsampled = false;
  long long white = 0;
  long long max_sample = 0;
  // One number per sample; more than two do not fit into the entry.
  const auto first_short = [&](std::size_t entry, long long value) -> long long {
    const bool is_elsewhere = file.integer<std::uint32_t>(entry + 4, order) > 2;
    return is_elsewhere
               ? file.integer<std::uint16_t>(file.integer<std::uint32_t>(entry + 8, order), order)
               : value;
  };
  for (int i = 0; i < entries; ++i) {
    const std::size_t entry = directory + 2 + 12 * static_cast<std::size_t>(i);
    const int tag = file.integer<std::uint16_t>(entry, order);
    const bool is_short = file.integer<std::uint16_t>(entry + 2, order) == 3;
    const long long value = is_short ? file.integer<std::uint16_t>(entry + 8, order)
                                     : file.integer<std::uint32_t>(entry + 8, order);
    if (tag == 256) {
      width = value;
    } else if (tag == 257) {
      height = value;
    } else if (tag == 258) {
      bits = first_short(entry, value);
    } else if (tag == 281) {
      max_sample = first_short(entry, value);
    } else if (tag == 50717) {
      white = first_short(entry, value);
    } else if (tag == 259) {
      compression = static_cast<int>(value);
    } else if (tag == 262) {
      is_subsampled = value == 6;
    } else if (tag == 277) {
      samples = value;
    }
  }
  file.check_dimensions(width, height);
  if (bits > 64 || samples > 64) {
    file.fail(fmt::format("has {} samples of {} bits per pixel, expected at most 64 of each",
                          samples, bits));
  }
  const long long pixel_bits = is_subsampled ? bits : bits * samples;
  if (const auto max = max_tiff_bytes_per_byte(compression, (pixel_bits + 7) / 8)) {
    check_holds_pixels(file, width, height, width * height * pixel_bits / 8 / *max);
  }
  if (bits > 8 && bits < 16) {
    return {.white_level = 65535};
  }
  white = white == 0 && max_sample > 0 && max_sample < 65535
              ? (1LL << std::bit_width(static_cast<unsigned>(max_sample))) - 1
              : white;
  return {.white_level = white > 0 && white < 65535 ? std::optional<double>(white) : std::nullopt};
}

Orientation check_webp(const FileBytes& file) {
  const std::size_t end = 8 + file.part(8, file.integer<std::uint32_t>(4, kLittle)).size();
  if (file.has_at(12, "VP8X")) {
    const auto side = [&](std::size_t offset) {
      return 1 + (file.integer<std::uint16_t>(offset, kLittle) | file.byte(offset + 2) << 16);
    };
    file.check_dimensions(side(24), side(27));
  } else if (file.has_at(12, "VP8L")) {
    const auto bits = file.integer<std::uint32_t>(21, kLittle);
    file.check_dimensions((bits & 0x3FFFU) + 1, (bits >> 14 & 0x3FFFU) + 1);
  } else {
    file.check_dimensions(file.integer<std::uint16_t>(26, kLittle) & 0x3FFF,
                          file.integer<std::uint16_t>(28, kLittle) & 0x3FFF);
  }
  for (std::size_t chunk = 12; chunk + 8 <= end;) {
    const std::size_t length = file.integer<std::uint32_t>(chunk + 4, kLittle);
    if (file.has_at(chunk, "EXIF")) {
      return exif_orientation(file.part(chunk + 8, length));
    }
    chunk += 8 + length + length % 2;
  }
  return Orientation::kAsStored;
}

std::string zero_ended_text(const FileBytes& file, std::size_t offset) {
  std::string text;
  for (std::uint8_t c = file.byte(offset); c != 0; c = file.byte(++offset)) {
    text.push_back(static_cast<char>(c));
    if (text.size() > 255) {
      file.fail("is damaged, a name in its EXR header is not terminated");
    }
  }
  return text;
}

/// Rows per block of an EXR file, by compression number.
constexpr std::array<int, 10> kExrBlockRows = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};

/// The blocks of a plain EXR file, whose positions are in a table at `offset`.
void check_exr_blocks(const FileBytes& file, std::size_t offset, long long height,
                      int compression) {
  if (compression >= static_cast<int>(kExrBlockRows.size())) {
    file.fail(fmt::format("is damaged, EXR compression {} does not exist", compression));
  }
  const int block_rows = kExrBlockRows[static_cast<std::size_t>(compression)];
  const auto blocks = static_cast<std::size_t>((height + block_rows - 1) / block_rows);
  for (std::size_t i = 0; i < blocks; ++i) {
    const auto block = file.integer<std::uint64_t>(offset + 8 * i, kLittle);
    (void)file.part(block, 8);
    (void)file.part(block + 8, file.integer<std::uint32_t>(block + 4, kLittle));
  }
}

void check_exr(const FileBytes& file) {
  constexpr std::uint32_t kTiledDeepOrMultipart = 0x1A00;
  const bool is_plain = (file.integer<std::uint32_t>(4, kLittle) & kTiledDeepOrMultipart) == 0;
  long long height = 0;
  int compression = 0;
  std::size_t offset = 8;
  while (file.byte(offset) != 0) {
    const std::string name = zero_ended_text(file, offset);
    offset += name.size() + 1;
    const std::string type = zero_ended_text(file, offset);
    offset += type.size() + 1;
    const std::size_t length = file.integer<std::uint32_t>(offset, kLittle);
    offset += 4;
    (void)file.part(offset, length);
    if (name == "dataWindow" && length == 16) {
      const auto corner = [&](std::size_t index) {
        return static_cast<long long>(
            static_cast<std::int32_t>(file.integer<std::uint32_t>(offset + 4 * index, kLittle)));
      };
      height = corner(3) - corner(1) + 1;
      file.check_dimensions(corner(2) - corner(0) + 1, height);
    } else if (name == "compression") {
      compression = file.byte(offset);
    }
    offset += length;
  }
  if (height == 0) {
    file.fail("is damaged, its EXR header has no data window");
  }
  if (is_plain) {
    check_exr_blocks(file, offset + 1, height, compression);
  }
}

}  // namespace

ImageFormat detect_image_format(const FileBytes& file) {
  using std::string_view_literals::operator""sv;
  if (file.has_at(0, "\x89PNG\r\n\x1A\n")) {
    return ImageFormat::kPng;
  }
  if (file.has_at(0, "\xFF\xD8\xFF")) {
    return ImageFormat::kJpeg;
  }
  if (file.has_at(0, "II\x2A\0"sv) || file.has_at(0, "MM\0\x2A"sv) ||
      file.has_at(0, "II\x2B\0"sv) || file.has_at(0, "MM\0\x2B"sv)) {
    return ImageFormat::kTiff;
  }
  if (file.has_at(0, "Pf") || file.has_at(0, "PF")) {
    return ImageFormat::kPfm;
  }
  if (file.has_at(0, "P") && file.size() > 2 && file.byte(1) >= '1' && file.byte(1) <= '6') {
    return ImageFormat::kPnm;
  }
  if (file.has_at(0, "BM")) {
    return ImageFormat::kBmp;
  }
  if (file.has_at(0, "RIFF") && file.has_at(8, "WEBP")) {
    return ImageFormat::kWebp;
  }
  if (file.has_at(0, "\x76\x2F\x31\x01")) {
    return ImageFormat::kExr;
  }
  file.fail("is not an image, expected PNG, JPEG, TIFF, PNM, PFM, BMP, WebP or EXR");
}

StatedByFile check_image_header(const FileBytes& file, ImageFormat format) {
  switch (format) {
    case ImageFormat::kBmp:
      check_bmp(file);
      break;
    case ImageFormat::kJpeg:
      return {.orientation = check_jpeg(file)};
    case ImageFormat::kTiff:
      return check_tiff(file);
    case ImageFormat::kWebp:
      return {.orientation = check_webp(file)};
    case ImageFormat::kExr:
      check_exr(file);
      break;
    case ImageFormat::kPng:
    case ImageFormat::kPnm:
    case ImageFormat::kPfm:
      break;
  }
  return {};
}

}  // namespace vantage
