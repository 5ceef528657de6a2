#pragma once

#include "engine/sequence/options/sequence_layout.h"
#include "engine/sequence/steps/frame_slot.h"

namespace vantage {

/// The picture of the frame in `stream`; null for masks and maps.
const Photograph* stored_picture(const FrameSlot& slot, const OutputStream& stream);

/// The mask of the frame in `stream`, which is of one. `reference`: of the run.
const Mask& mask_of(const FrameSlot& slot, const OutputStream& stream, Side reference);

/// Copies the picture or mask of the frame in `stream` (not of floats) to `picture`, whose memory
/// is reused.
void copy_picture(const FrameSlot& slot, const OutputStream& stream, Side reference,
                  Photograph& picture);

}  // namespace vantage
