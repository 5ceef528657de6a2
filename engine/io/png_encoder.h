#pragma once

#include <cstdint>
#include <vector>

#include "engine/image/image.h"

namespace vantage {

/// Makes `bytes` the PNG file of an image with 1, 3 (RGB) or 4 (RGBA) channels, compressed for
/// speed; the same file that OpenCV writes. Leaves `bytes` empty when PNG has no files of that
/// size. Thread rule: may be called concurrently.
void encode_png(const Image<std::uint8_t>& image, std::vector<std::uint8_t>& bytes);
void encode_png(const Image<std::uint16_t>& image, std::vector<std::uint8_t>& bytes);

}  // namespace vantage
