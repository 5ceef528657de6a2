#pragma once

#include <cstdint>
#include <span>

#include "engine/image/orientation.h"

namespace vantage {

/// The orientation of a block of EXIF data, which is a TIFF file without pixels; as stored where it
/// has none, or is damaged. Thread rule: pure.
Orientation exif_orientation(std::span<const std::uint8_t> exif);

}  // namespace vantage
