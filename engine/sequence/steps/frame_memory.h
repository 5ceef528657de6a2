#pragma once

#include <cstddef>

#include "engine/sequence/steps/frame_slot.h"

namespace vantage {

/// Bytes of a frame in flight: photographs, maps, views, pictures and the file being written.
/// Excludes data that its source has fetched but not yet decoded.
std::size_t held_bytes(const FrameSlot& slot);

}  // namespace vantage
