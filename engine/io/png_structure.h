#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/io/file_bytes.h"

namespace vantage {

/// What a PNG file is made of. Refers to the bytes of the file.
struct PngStructure {
  int width = 0;
  int height = 0;
  int bit_depth = 0;    ///< of a channel or a palette index: 1, 2, 4, 8 or 16
  int colour_type = 0;  ///< 0 grey, 2 RGB, 3 palette, 4 grey with alpha, 6 RGBA
  bool interlaced = false;
  bool has_transparent_colour = false;                    ///< a tRNS chunk
  std::vector<std::span<const std::uint8_t>> pixel_data;  ///< contents of the IDAT chunks
  /// Whole chunks, with length, name and checksum, that pixels depend on: IHDR, PLTE, tRNS, IDAT,
  /// IEND.
  std::vector<std::span<const std::uint8_t>> essential_chunks;
};

/// Walks the chunks of a PNG file up to IEND: lengths, checksums of the chunks that matter, sane
/// dimensions, and compressed data long enough for them. Throws Error for a damaged or truncated
/// file.
PngStructure check_png_structure(const FileBytes& file);

/// A PNG file of the essential chunks alone: colour profiles, gamma, orientation and text must not
/// reach a decoder that acts on some and complains about others.
std::vector<std::uint8_t> strip_png(const PngStructure& structure);

}  // namespace vantage
