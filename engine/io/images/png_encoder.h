#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "engine/image/image.h"

namespace vantage {

class Execution;

/// Encodes an image with 1, 3 (RGB) or 4 (RGBA) channels as PNG to `bytes`, optimised for speed:
/// 200 to 350 megapixels a second and core, where libpng and libdeflate reach 50 and 90. Strips of
/// rows are encoded side by side by `execution`; null: one after the other. Files are identical on
/// every processor and for any execution. `bytes` stays empty if a side has more than 1 000 000
/// pixels, because libpng cannot read such files. Thread rule: may be called concurrently.
void encode_png(const Image<std::uint8_t>& image, std::vector<std::uint8_t>& bytes,
                Execution* execution = nullptr);
void encode_png(const Image<std::uint16_t>& image, std::vector<std::uint8_t>& bytes,
                Execution* execution = nullptr);

/// The values of row y, which may be made in `memory`, of a row's size. Thread rule: concurrently.
using PngRowSource = std::function<const std::uint16_t*(int y, std::uint16_t* memory)>;

/// Encodes a 16-bit grey image row by row: `row` makes each row just before it is encoded, so that
/// the image need not be stored.
void encode_png(int width, int height, const PngRowSource& row, std::vector<std::uint8_t>& bytes,
                Execution* execution = nullptr);

}  // namespace vantage
