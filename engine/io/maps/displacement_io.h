#pragma once

#include <filesystem>

#include "engine/image/displacement_view.h"
#include "engine/image/side.h"

namespace vantage {

/// Writes both components of the displacements from the pixels of one image to their partners in
/// the other: (u, v) = (x, y) of the partner − (x, y) of the pixel, to the right and down. For the
/// map of the left image these are the negative disparities, for that of the right image the
/// positive ones.
///
/// By extension (map_formats.h): .flo (Middlebury optical flow: "PIEH", width and height as 32-bit
/// integers, then u, v interleaved as floats, row by row from the top, all little-endian; unknown =
/// 1e10), .npy (shape (height, width, 2), unknown = NaN), .tiff/.exr (float, three channels R = u,
/// G = v, B = 1 where known; unknown = 0, 0, 0). NaN and ±inf in either component are unknown.
/// Writes atomically. Throws UsageError for another extension, Error when the file cannot be
/// written. Thread rule: may be called concurrently for different files.
void write_displacements(const std::filesystem::path& path, const DisplacementView& displacements,
                         Side side);

}  // namespace vantage
