#pragma once

#include <optional>

#include "engine/image/orientation.h"
#include "engine/io/files/file_bytes.h"

namespace vantage {

enum class ImageFormat { kPng, kJpeg, kTiff, kPnm, kPfm, kBmp, kWebp, kExr };

/// The format according to the first bytes, whatever the file's name. Throws Error for anything
/// else.
ImageFormat detect_image_format(const FileBytes& file);

/// What a header says of the pixels.
struct StatedByFile {
  std::optional<double> white_level = {};  ///< PhotographOrigin::white_level, of TIFF
  Orientation orientation = Orientation::kAsStored;
};

/// Read by our own code, because OpenCV allocates what a header says before it looks at the data.
/// Checks before decoding: dimensions in bounds and, for BMP, JPEG, WebP and EXR, that the file is
/// complete, for TIFF and JPEG that it can hold so many pixels. For the formats that OpenCV
/// decodes, except PNG (see png_decoder.h). Throws Error.
StatedByFile check_image_header(const FileBytes& file, ImageFormat format);

}  // namespace vantage
