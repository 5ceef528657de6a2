#pragma once

#include "engine/sequence/frame_range.h"
#include "engine/sequence/sequence_layout.h"

namespace vantage {

/// Removes what a process that was killed left behind without a name while it worked on `frames`:
/// hidden files of those frames in the folders of the layout. Files that cannot be removed stay.
void remove_leftovers(const SequenceLayout& layout, FrameRange frames);

}  // namespace vantage
