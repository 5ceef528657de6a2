#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "engine/image/image.h"

namespace vantage {

/// Encodes depths in metres (NaN = unknown) to `bytes`, whose memory is reused: the content that
/// write_depth() writes to `path`. Errors as write_depth().
void encode_depth(const std::filesystem::path& path, ImageView<const float> depth_m,
                  std::vector<std::uint8_t>& bytes);

/// Writes by extension (map_formats.h): 16-bit .png in millimetres (0 = unknown; depths below half
/// a millimetre are stored as 1), or .pfm (+inf = unknown), .tiff, .exr, .npy (NaN) in metres.
/// Writes atomically. Throws UsageError for another extension, Error when the file cannot be
/// written or a depth exceeds kMaxIntegerDepth_m in a PNG. Thread rule: may be called concurrently
/// for different files.
void write_depth(const std::filesystem::path& path, ImageView<const float> depth_m);

/// The maximum depth that a file named `path` holds; infinity if there is no limit.
double largest_depth_m(const std::filesystem::path& path);

}  // namespace vantage
