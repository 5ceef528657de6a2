#pragma once

#include "engine/io/file_bytes.h"

namespace vantage {

enum class ImageFormat { kPng, kJpeg, kTiff, kPnm, kPfm, kBmp, kWebp, kExr };

/// The format the first bytes say, whatever the file is called. Throws Error for anything else.
ImageFormat detect_image_format(const FileBytes& file);

/// Checks what can be checked before decoding: dimensions in bounds and, for BMP, JPEG, WebP
/// and EXR, that the file is there to its end. For the formats that OpenCV decodes, PNG aside (see
/// png_structure.h). Throws Error.
void check_image_header(const FileBytes& file, ImageFormat format);

}  // namespace vantage
