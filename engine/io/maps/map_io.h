#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "engine/image/displacement_view.h"
#include "engine/image/image.h"
#include "engine/image/side.h"
#include "engine/remark.h"

namespace vantage {

class Execution;

/// Reads a disparity map; its content determines the format: .pfm (±inf = unknown), 16-bit .png
/// (÷256, 0 = unknown), .tiff/.exr (float, NaN = unknown), .npy (floats or integers), 8-bit
/// .png/.pgm (÷scale, 0 = unknown), .tiff of integers, with or without a sign. `scale` (> 0)
/// divides integer values and replaces the 256 of 16-bit PNG when given; 0 means the format's
/// default (other files have none: Error). Unknown becomes NaN (stored_map.h, also of OpenCV's
/// maps). `remarks`, if given, gets what was assumed. Throws Error naming the file and the problem,
/// UsageError for a negative scale. Thread rule: may be called concurrently.
DisparityMap read_disparity(const std::filesystem::path& path, double scale = 0,
                            std::vector<Remark>* remarks = nullptr);

/// Reads a depth map in metres, in the same formats: values divided by `scale`, their number per
/// metre (> 0); 0: 1000 for integers, 1 for floats. Unknown, 0 and negative become NaN. Otherwise
/// as read_disparity().
Image<float> read_depth(const std::filesystem::path& path, double scale = 0,
                        std::vector<Remark>* remarks = nullptr);

/// Reads a file with one channel of floats, which may be NaN: .tiff, .pfm, .exr, .npy. Infinite
/// values become NaN. Throws Error naming the file and the problem.
Image<float> read_float_image(const std::filesystem::path& path);

/// Writes by extension (map_formats.h): .pfm (little-endian, bottom-up, unknown = +inf), .png
/// (16-bit, ×256, 0 = unknown; values out of range are an Error; known values that round to 0
/// become 1/256, as in KITTI's own files), .tiff/.exr (float, NaN), .npy (float32). NaN and ±inf in
/// memory are unknown. Writes atomically. Throws UsageError for another extension, Error when the
/// file cannot be written. `execution`: encode_png().
void write_disparity(const std::filesystem::path& path, ImageView<const float> disparity,
                     Execution* execution = nullptr);

/// Encodes the map to `bytes`, whose memory is reused: the content that write_disparity() writes to
/// `path`. Errors as write_disparity().
void encode_disparity(const std::filesystem::path& path, ImageView<const float> disparity,
                      std::vector<std::uint8_t>& bytes, Execution* execution = nullptr);

/// Throws UsageError unless a file named `path` can hold every disparity of a search from min_px
/// to max_px: a 16-bit PNG holds 0 to 255.99. Call it before the search, whose result would
/// otherwise be lost.
void require_holds_search(const std::filesystem::path& path, int min_px, int max_px);

/// Encodes depths in metres (NaN = unknown) to `bytes`, whose memory is reused: the content that
/// write_depth() writes to `path`. Errors as write_depth().
void encode_depth(const std::filesystem::path& path, ImageView<const float> depth_m,
                  std::vector<std::uint8_t>& bytes, Execution* execution = nullptr);

/// Writes by extension (map_formats.h): 16-bit .png in millimetres (0 = unknown; depths below half
/// a millimetre are stored as 1), or .pfm (+inf = unknown), .tiff, .exr, .npy (NaN) in metres.
/// Writes atomically. Throws UsageError for another extension, Error when the file cannot be
/// written or a depth exceeds kMaxIntegerDepth_m in a PNG. Thread rule: may be called concurrently
/// for different files.
void write_depth(const std::filesystem::path& path, ImageView<const float> depth_m);

/// The maximum depth that a file named `path` holds; infinity if there is no limit.
double largest_depth_m(const std::filesystem::path& path);

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
