#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "engine/image/photograph.h"

namespace vantage {

/// Largest accepted width or height, and largest accepted number of pixels of one image: beyond
/// them a header is taken for damaged before any memory is asked for.
inline constexpr int kMaxImageSide = 65500;
inline constexpr long long kMaxImagePixels = 1LL << 28;

/// The number of pixels that this process accepts, in images and videos: kMaxImagePixels unless it
/// has been set to 1 to that many. Throws UsageError beyond. Thread rule: may be called
/// concurrently; what is read meanwhile has the old limit or the new one.
long long max_image_pixels();
void set_max_image_pixels(long long pixels);

/// Reads PNG, JPEG, TIFF, PNM, BMP, WebP, EXR (by OpenCV) and PFM. 8- and 16-bit and float, grey,
/// RGB or RGBA, as the file's content says, whatever its name; PNM values are stretched from the
/// file's largest value to the type's. EXIF orientation, gamma and colour profiles are ignored.
/// Thread rule: may be called concurrently. Throws Error naming the file when it is missing, empty,
/// truncated, not an image, absurdly large in its header, or float with NaN or infinity.
/// The photograph takes the memory of `memory` where that has its depth and size.
Photograph read_photograph(const std::filesystem::path& path, Photograph memory = {});

/// Makes `bytes`, whose memory is reused, those of an image file named `path`: what
/// write_photograph() writes, and it throws alike.
void encode_photograph(const std::filesystem::path& path, const Photograph& photograph,
                       std::vector<std::uint8_t>& bytes);

/// Writes by extension (.png .jpg .tiff .bmp .ppm .pgm .webp .exr .pfm); whole or not at all.
/// Throws Error when the folder cannot be written or the format cannot hold the depth or channels,
/// UsageError for an unknown extension. Thread rule: may be called concurrently.
void write_photograph(const std::filesystem::path& path, const Photograph& photograph);

/// Writes a mask as 8-bit grey PNG; whole or not at all. Throws as write_photograph() does.
void write_mask(const std::filesystem::path& path, ImageView<const std::uint8_t> mask);

}  // namespace vantage
