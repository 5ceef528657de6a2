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

constexpr std::string_view kCodestream("\xFF\x4F\xFF\x51", 4);

/// Two bytes of a run are at most 255 pixels.
constexpr long long kMaxRunPixelsPerByte = 128;
/// Arithmetic code has no such minimum; this is far beyond what photographs reach.
constexpr long long kMaxArithmeticPixelsPerByte = 65536;

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

/// The size in the codestream, which begins with its markers SOC and SIZ. In a JP2 file boxes come
/// before it.
void check_jpeg2000(const FileBytes& file) {
  std::size_t offset = 0;
  while (!file.has_at(offset, kCodestream)) {
    const bool is_codestream_box = file.has_at(offset + 4, "jp2c");
    std::size_t header = 8;
    std::size_t length = file.integer<std::uint32_t>(offset, kBig);
    if (length == 1) {
      header = 16;
      length = file.integer<std::uint64_t>(offset + 8, kBig);
    }
    if (!is_codestream_box && length < header) {
      file.fail("is damaged, its JPEG 2000 boxes hold no codestream");
    }
    offset += is_codestream_box ? header : length;
    (void)file.part(offset, kCodestream.size());
    if (is_codestream_box && !file.has_at(offset, kCodestream)) {
      file.fail("is damaged, its JPEG 2000 codestream has no header");
    }
  }
  const auto number = [&](std::size_t at) {
    return static_cast<long long>(file.integer<std::uint32_t>(offset + at, kBig));
  };
  const long long width = number(8) - number(16);
  const long long height = number(12) - number(20);
  file.check_dimensions(width, height);
  check_holds_pixels(file, width, height, width * height / kMaxArithmeticPixelsPerByte);
}

/// Formats that users have, and that are not read, by what their files hold at `offset`.
struct OtherFormat {
  std::size_t offset;
  std::string_view bytes;
  std::string_view name;
};
constexpr OtherFormat kOtherFormats[] = {{4, "ftypavi", "AVIF"},
                                         {4, "ftyphe", "HEIC"},
                                         {4, "ftypmif1", "HEIF"},
                                         {4, "ftypmsf1", "HEIF"},
                                         {4, "JXL ", "JPEG XL"},
                                         {0, "\xFF\x0A", "JPEG XL"},
                                         {0, "GIF8", "GIF"},
                                         {0, "SDPX", "DPX"},
                                         {0, "XPDS", "DPX"},
                                         {0, "8BPS", "a Photoshop file"},
                                         {0, "#?R", "Radiance HDR"},
                                         {0, "SIMPLE  =", "FITS"},
                                         {0, "II\xBC\x01", "JPEG XR"},
                                         {4, "ftyp", "a film"},
                                         {0, "\x1A\x45\xDF\xA3", "a film"}};

[[noreturn]] void fail_as_unknown(const FileBytes& file) {
  std::string_view name = lower_case_extension(file.name()) == ".tga" ? "TGA" : "";
  for (const OtherFormat& other : kOtherFormats) {
    name = name.empty() && file.has_at(other.offset, other.bytes) ? other.name : name;
  }
  if (name == "a film") {
    file.fail("is a film, expected an image; 'vantage run' reads films");
  }
  if (!name.empty()) {
    file.fail(
        fmt::format("is {}, which is not read; convert it to PNG or TIFF, for example with "
                    "ImageMagick or FFmpeg",
                    name));
  }
  file.fail("is not an image, expected PNG, JPEG, TIFF, JPEG 2000, PNM, PFM, BMP, WebP or EXR");
}

}  // namespace

void check_holds_pixels(const FileBytes& file, long long width, long long height,
                        long long min_bytes) {
  if (min_bytes > static_cast<long long>(file.size())) {
    file.fail(fmt::format("is damaged, {} bytes cannot hold the {}x{} pixels of its header",
                          file.size(), width, height));
  }
}

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
  if (file.has_at(0, kCodestream) || file.has_at(4, "jP  \r\n\x87\n")) {
    return ImageFormat::kJpeg2000;
  }
  fail_as_unknown(file);
}

StatedByFile check_image_header(const FileBytes& file, ImageFormat format) {
  switch (format) {
    case ImageFormat::kBmp:
      check_bmp(file);
      break;
    case ImageFormat::kJpeg:
      return {.orientation = check_jpeg(file)};
    case ImageFormat::kWebp:
      return {.orientation = check_webp(file)};
    case ImageFormat::kExr:
      check_exr(file);
      break;
    case ImageFormat::kJpeg2000:
      check_jpeg2000(file);
      break;
    case ImageFormat::kTiff:
    case ImageFormat::kPng:
    case ImageFormat::kPnm:
    case ImageFormat::kPfm:
      break;
  }
  return {};
}

}  // namespace vantage
