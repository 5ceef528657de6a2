#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/image/image.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/maps/stored_map.h"

namespace vantage {

// Our own reader and writer: Debian has no library for NumPy's files.

/// True when `file` starts like a NumPy array file.
bool is_npy(const FileBytes& file);

/// Decodes a NumPy array file, format versions 1 to 3: floats of 16, 32 and 64 bits or integers of
/// 8 to 64, little-endian, rounded to float; C or Fortran order; of shape (height, width),
/// also with further sides of 1 before or after. Throws Error that names any other type or shape.
StoredMap decode_npy(const FileBytes& file);

/// Encodes as <f4 in C order, format version 1.0; of shape (height, width), or (height, width,
/// channels) for several channels.
std::vector<std::uint8_t> encode_npy(ImageView<const float> image);

/// What precedes the <f4 values of a file of this shape, format version 1.0.
std::vector<std::uint8_t> npy_float_header(std::span<const int> shape);

}  // namespace vantage
