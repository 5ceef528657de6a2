#pragma once

#include "engine/sequence/frame_range.h"
#include "engine/sequence/sequence_layout.h"

namespace vantage {

/// Removes hidden files of `frames` that a killed process left in the folders of the layout. Files
/// that cannot be removed stay.
void remove_leftovers(const SequenceLayout& layout, FrameRange frames);

}  // namespace vantage
