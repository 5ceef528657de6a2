#pragma once

#include "engine/sequence/options/sequence_layout.h"
#include "engine/sequence/pairs/frame_range.h"

namespace vantage {

/// Removes hidden files of `frames` that a killed process left in the folders of the layout. Files
/// that cannot be removed stay.
void remove_leftovers(const SequenceLayout& layout, FrameRange frames);

}  // namespace vantage
