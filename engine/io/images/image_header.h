#pragma once

#include <optional>

#include "engine/image/orientation.h"
#include "engine/io/files/file_bytes.h"

namespace vantage {

enum class ImageFormat { kPng, kJpeg, kTiff, kPnm, kPfm, kBmp, kWebp, kExr, kJpeg2000 };

/// The format according to the first bytes, whatever the file's name. Throws Error for anything
/// else, naming formats that are known but not read.
ImageFormat detect_image_format(const FileBytes& file);

/// What a header says of the pixels.
struct StatedByFile {
  Orientation orientation = Orientation::kAsStored;
  int integer_bits = 0;                ///< as of DecodedImage, of TIFF
  std::optional<double> no_data = {};  ///< the value of pixels that show nothing, of TIFF
};

/// Pixels that a byte of Huffman-coded JPEG can stand for: each 8×8 block takes at least one bit.
/// Doubled, because components may be subsampled.
inline constexpr long long kMaxJpegPixelsPerByte = 1024;

/// Checked before allocation: a few bytes must not allocate gigabytes. `min_bytes`: what an image
/// takes at least. Throws Error.
void check_holds_pixels(const FileBytes& file, long long width, long long height,
                        long long min_bytes);

/// Read by our own code, because OpenCV allocates what a header says before it looks at the data.
/// Checks before decoding: dimensions in bounds and, for BMP, JPEG, WebP and EXR, that the file is
/// complete, for JPEG that it can hold so many pixels. For the formats that OpenCV decodes, and
/// JPEG. Throws Error.
StatedByFile check_image_header(const FileBytes& file, ImageFormat format);

}  // namespace vantage
