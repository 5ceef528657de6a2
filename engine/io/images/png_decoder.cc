#include "engine/io/images/png_decoder.h"

#include <fmt/format.h>
#include <libdeflate.h>

#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/io/images/exif.h"

namespace vantage {
namespace {

constexpr std::array<std::uint8_t, 8> kPngSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};

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

/// The bytes of all rows, each preceded by its filter number.
struct FilteredRows {
  std::unique_ptr<std::uint8_t[]> bytes;
  std::size_t row_bytes = 0;  ///< without the filter

  [[nodiscard]] std::uint8_t* row(int y) const {
    return bytes.get() + (row_bytes + 1) * static_cast<std::size_t>(y);
  }
};

bool decompress(std::span<const std::span<const std::uint8_t>> parts, std::span<std::uint8_t> to) {
  struct Free {
    void operator()(libdeflate_decompressor* decompressor) const {
      libdeflate_free_decompressor(decompressor);
    }
  };
  const std::unique_ptr<libdeflate_decompressor, Free> decompressor(
      libdeflate_alloc_decompressor());
  std::vector<std::uint8_t> joined;
  std::span<const std::uint8_t> compressed = parts.front();
  if (parts.size() > 1) {
    std::size_t bytes = 0;
    for (const auto part : parts) {
      bytes += part.size();
    }
    joined.reserve(bytes);
    for (const auto part : parts) {
      joined.insert(joined.end(), part.begin(), part.end());
    }
    compressed = joined;
  }
  // Without an output for the actual size, success means exactly the expected size.
  return decompressor &&
         libdeflate_zlib_decompress(decompressor.get(), compressed.data(), compressed.size(),
                                    to.data(), to.size(), nullptr) == LIBDEFLATE_SUCCESS;
}

std::uint8_t nearest_to_gradient(int left, int up, int up_left) {
  const int to_left = std::abs(up - up_left);
  const int to_up = std::abs(left - up_left);
  const int to_up_left = std::abs(left + up - 2 * up_left);
  const int vertical = to_up <= to_up_left ? up : up_left;
  return static_cast<std::uint8_t>(to_left <= to_up && to_left <= to_up_left ? left : vertical);
}

/// Undoes a PNG filter in place. `up`: the decoded row above; zeros for the first row. kPixelBytes:
/// bytes per pixel. False for an unknown filter.
template <int kPixelBytes>
bool undo_filter(int filter, const std::uint8_t* up, std::size_t count, std::uint8_t* row) {
  const auto add = [row](std::size_t i, int prediction) {
    row[i] = static_cast<std::uint8_t>(row[i] + prediction);
  };
  switch (filter) {
    case 0:
      return true;
    case 1:
      for (std::size_t i = kPixelBytes; i < count; ++i) {
        add(i, row[i - kPixelBytes]);
      }
      return true;
    case 2:
      for (std::size_t i = 0; i < count; ++i) {
        add(i, up[i]);
      }
      return true;
    case 3:
      for (std::size_t i = 0; i < kPixelBytes; ++i) {
        add(i, up[i] / 2);
      }
      for (std::size_t i = kPixelBytes; i < count; ++i) {
        add(i, (row[i - kPixelBytes] + up[i]) / 2);
      }
      return true;
    case 4:
      for (std::size_t i = 0; i < kPixelBytes; ++i) {
        add(i, up[i]);
      }
      for (std::size_t i = kPixelBytes; i < count; ++i) {
        add(i, nearest_to_gradient(row[i - kPixelBytes], up[i], up[i - kPixelBytes]));
      }
      return true;
    default:
      return false;
  }
}

template <int kPixelBytes>
bool undo_filters(const FilteredRows& rows, int height) {
  const std::vector<std::uint8_t> above_first(rows.row_bytes);
  const std::uint8_t* up = above_first.data();
  for (int y = 0; y < height; ++y) {
    std::uint8_t* row = rows.row(y) + 1;
    if (!undo_filter<kPixelBytes>(rows.row(y)[0], up, rows.row_bytes, row)) {
      return false;
    }
    up = row;
  }
  return true;
}

bool undo_filters(int pixel_bytes, const FilteredRows& rows, int height) {
  switch (pixel_bytes) {
    case 1:
      return undo_filters<1>(rows, height);
    case 2:
      return undo_filters<2>(rows, height);
    case 3:
      return undo_filters<3>(rows, height);
    case 4:
      return undo_filters<4>(rows, height);
    case 6:
      return undo_filters<6>(rows, height);
    default:
      return undo_filters<8>(rows, height);
  }
}

void copy_row(const std::uint8_t* bytes, std::size_t count, std::uint8_t* values) {
  std::memcpy(values, bytes, count);
}

/// Big-endian in the file.
void copy_row(const std::uint8_t* bytes, std::size_t count, std::uint16_t* values) {
  for (std::size_t i = 0; i < count / 2; ++i) {
    values[i] = static_cast<std::uint16_t>(bytes[2 * i] << 8 | bytes[2 * i + 1]);
  }
}

template <typename T>
Photograph to_photograph(const FilteredRows& rows, ImageShape shape, Photograph& memory) {
  Image<T> image = take_image<T>(memory, shape);
  for (int y = 0; y < shape.height; ++y) {
    copy_row(rows.row(y) + 1, rows.row_bytes, image.row(y));
  }
  return {std::move(image)};
}

}  // namespace

PngStructure check_png_structure(const FileBytes& file) {
  PngStructure structure;
  (void)file.part(0, kPngSignature.size());
  std::size_t raw_bytes = 0;
  std::size_t compressed_bytes = 0;
  std::string type;
  for (std::size_t offset = kPngSignature.size(); type != "IEND";) {
    const std::size_t length = file.integer<std::uint32_t>(offset, std::endian::big);
    const auto chunk = file.part(offset, length + 12);
    type.assign(chunk.begin() + 4, chunk.begin() + 8);
    if ((offset == kPngSignature.size()) != (type == "IHDR") || (type == "IHDR" && length != 13)) {
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
    } else if (type == "sBIT" && length > 0) {
      structure.significant_bits = *std::max_element(chunk.begin() + 8, chunk.end() - 4);
    } else if (type == "eXIf") {
      structure.orientation = exif_orientation(chunk.subspan(8, length));
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
  std::vector<std::uint8_t> file(kPngSignature.begin(), kPngSignature.end());
  for (const auto chunk : structure.essential_chunks) {
    file.insert(file.end(), chunk.begin(), chunk.end());
  }
  return file;
}

std::optional<Photograph> decode_usual_png(const PngStructure& structure, Photograph& memory) {
  const bool usual_colour =
      structure.colour_type == 0 || structure.colour_type == 2 || structure.colour_type == 6;
  if (!usual_colour || structure.bit_depth < 8 || structure.interlaced ||
      structure.has_transparent_colour) {
    return std::nullopt;
  }
  const int channels = structure.colour_type == 0 ? 1 : structure.colour_type == 2 ? 3 : 4;
  const int pixel_bytes = channels * structure.bit_depth / 8;
  FilteredRows rows;
  rows.row_bytes =
      static_cast<std::size_t>(structure.width) * static_cast<std::size_t>(pixel_bytes);
  const std::size_t total = (rows.row_bytes + 1) * static_cast<std::size_t>(structure.height);
  rows.bytes = std::make_unique_for_overwrite<std::uint8_t[]>(total);
  if (!decompress(structure.pixel_data, {rows.bytes.get(), total}) ||
      !undo_filters(pixel_bytes, rows, structure.height)) {
    return std::nullopt;
  }
  const ImageShape shape{structure.width, structure.height, channels};
  return structure.bit_depth == 8 ? to_photograph<std::uint8_t>(rows, shape, memory)
                                  : to_photograph<std::uint16_t>(rows, shape, memory);
}

}  // namespace vantage
