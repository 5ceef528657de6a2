#pragma once

#include <optional>

#include "engine/image/photograph.h"
#include "engine/io/files/file_bytes.h"

namespace vantage {

// What image files state of the value of white. Of 16-bit integers; empty: nothing, or what its
// values contradict. Damaged statements count as none. Thread rule: pure.

/// The first directory of a TIFF file: WhiteLevel (of DNG), else MaxSampleValue rounded up to 2ⁿ −
/// 1 unless it is 65535, which says nothing; or BitsPerSample of 10, 12 or 14, which decoders scale
/// to 16 bits.
std::optional<double> tiff_white_level(const FileBytes& file, const Photograph& photograph);

/// sBIT of n bits: 2ⁿ − 1 if all values are at most that; else they were scaled to 16 bits, as the
/// standard demands. Also tiff_white_level() of the EXIF data.
std::optional<double> png_white_level(const FileBytes& file, const Photograph& photograph);

}  // namespace vantage
