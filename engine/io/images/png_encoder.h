#pragma once

#include <cstdint>
#include <vector>

#include "engine/image/image.h"

namespace vantage {

/// Our own writer, because libpng compresses with zlib: libdeflate takes a fraction of its time.
/// Encodes an image with 1, 3 (RGB) or 4 (RGBA) channels as PNG to `bytes`, optimised for speed.
/// Files are identical on every processor. `bytes` stays empty if a side has more than 1 000 000
/// pixels, because libpng cannot read such files. Thread rule: may be called concurrently.
void encode_png(const Image<std::uint8_t>& image, std::vector<std::uint8_t>& bytes);
void encode_png(const Image<std::uint16_t>& image, std::vector<std::uint8_t>& bytes);

}  // namespace vantage
