#pragma once

#include "engine/image/photograph.h"
#include "engine/io/files/file_bytes.h"

namespace vantage {

/// The pixels of a JPEG file as stored: grey stays grey, everything else becomes RGB (including
/// CMYK); the EXIF orientation is ignored. Damage for which libjpeg-turbo only warns and fills in
/// grey is an Error too. Reuses `memory` if it has the pixels' depth and size. Thread rule: may be
/// called concurrently.
Photograph decode_jpeg(const FileBytes& file, Photograph& memory);

}  // namespace vantage
