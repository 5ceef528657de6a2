#pragma once

#include <cstdint>
#include <vector>

#include "engine/io/file_bytes.h"

namespace vantage {

/// Walks the chunks of a PNG file up to IEND: lengths, checksums of the chunks that matter, sane
/// dimensions, and compressed data long enough for them. Returns those chunks alone, as a PNG file:
/// colour profiles, gamma, orientation and text must not reach the decoder, which acts on some and
/// complains about others. Throws Error for a damaged or truncated file.
std::vector<std::uint8_t> check_and_strip_png(const FileBytes& file);

}  // namespace vantage
