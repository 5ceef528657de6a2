#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/image/photograph.h"
#include "engine/io/files/file_bytes.h"

namespace vantage {

/// Structure of a PNG file, read by our own code: libpng does not compare the size of a file with
/// that of its pixels, and applies what must be ignored here. Refers to the bytes of the file.
struct PngStructure {
  int width = 0;
  int height = 0;
  int bit_depth = 0;         ///< per channel or palette index: 1, 2, 4, 8 or 16
  int colour_type = 0;       ///< 0 grey, 2 RGB, 3 palette, 4 grey with alpha, 6 RGBA
  int significant_bits = 0;  ///< of an sBIT chunk, of the channel that has most; 0: not stated
  bool interlaced = false;
  Orientation orientation = Orientation::kAsStored;       ///< of an eXIf chunk
  bool has_transparent_colour = false;                    ///< a tRNS chunk
  std::vector<std::span<const std::uint8_t>> pixel_data;  ///< contents of the IDAT chunks
  /// Complete chunks, with length, name and checksum, that pixels depend on: IHDR, PLTE, tRNS,
  /// IDAT, IEND.
  std::vector<std::span<const std::uint8_t>> essential_chunks;
};

/// Checks the chunks of a PNG file up to IEND: lengths, checksums of the essential chunks,
/// plausible dimensions, and enough compressed data for them. Throws Error for a damaged or
/// truncated file.
PngStructure check_png_structure(const FileBytes& file);

/// A PNG file of the essential chunks only: colour profiles, gamma, orientation and text must not
/// reach a decoder that applies some and complains about others.
std::vector<std::uint8_t> strip_png(const PngStructure& structure);

/// Our own decoder, with libdeflate, because libpng inflates with zlib.
/// The pixels of a PNG file of the common kinds (8 or 16 bits of grey, RGB or RGBA; no palette, no
/// transparent colour, not interlaced), in a third of libpng's time. Empty for other kinds, and
/// when the compressed data does not have exactly the size in the header: libpng decides about
/// those. Reuses `memory` if it has the pixels' depth and size.
std::optional<Photograph> decode_usual_png(const PngStructure& structure, Photograph& memory);

/// The pixels of any PNG file: palettes become RGB, a transparent colour alpha, and fewer than 8
/// bits 8. `png` is the file with its essential chunks only. Throws Error naming `file` when libpng
/// finds it damaged.
Photograph decode_any_png(const FileBytes& file, std::span<const std::uint8_t> png,
                          Photograph& memory);

}  // namespace vantage
