#pragma once

#include <cstddef>

#include "engine/sequence/frame_slot.h"

namespace vantage {

/// What the images of a frame under way take: photographs, maps, views, pictures and the file being
/// written. Not what its source has fetched and not yet decoded.
std::size_t held_bytes(const FrameSlot& slot);

}  // namespace vantage
