#pragma once

#include <cstdint>
#include <vector>

#include "engine/image/photograph.h"
#include "engine/io/files/file_bytes.h"

namespace vantage {

/// A PNM file's values as stored, 0..max_value, 8-bit up to 255 and 16-bit above. Bitmaps become 0
/// (black) and 255.
struct PnmImage {
  Photograph photograph;
  int max_value = 255;
};

/// Decodes PBM, PGM and PPM, text or binary (P1..P6). Throws Error.
PnmImage decode_pnm(const FileBytes& file);

/// Encodes 8- or 16-bit, 1 channel as P5, 3 channels as P6.
std::vector<std::uint8_t> encode_pnm(const Photograph& photograph);

}  // namespace vantage
