#pragma once

#include "engine/image/photograph.h"
#include "engine/io/file_bytes.h"

namespace vantage {

/// The pixels of a JPEG file as it was stored: grey stays grey, all else becomes RGB (CMYK, too);
/// the EXIF orientation is ignored. What libjpeg-turbo would only warn of, and fill up with grey,
/// is an Error as well. The pixels take the memory of `memory` where that has their depth and size.
/// Thread rule: may be called concurrently.
Photograph decode_jpeg(const FileBytes& file, Photograph& memory);

}  // namespace vantage
