#pragma once

#include "engine/sequence/options/sequence_layout.h"
#include "engine/sequence/pairs/frame_range.h"

namespace vantage {

/// Removes hidden files of `frames` that a killed process left in the folders of the layout. Files
/// that cannot be removed stay.
void remove_leftovers(const SequenceLayout& layout, FrameRange frames);

/// Throws Error if files named like results of a run are where one would write them, and there is
/// no journal of a run that made them.
void require_no_foreign_files(const SequenceLayout& layout);

}  // namespace vantage
