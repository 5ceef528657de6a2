#pragma once

#include <optional>

#include "engine/image/photograph.h"
#include "engine/io/images/png_structure.h"

namespace vantage {

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
