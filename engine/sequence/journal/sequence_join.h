#pragma once

#include <string>

#include "engine/sequence/journal/delivered_frames.h"
#include "engine/sequence/journal/run_journal.h"
#include "engine/sequence/options/sequence_layout.h"
#include "engine/sequence/options/sequence_options.h"
#include "engine/sequence/pairs/frame_range.h"

namespace vantage {

/// The range from the first to the last delivered frame; empty if there are none or gaps between
/// them.
FrameRange contiguous_frames(const DeliveredFrames& delivered, int frame_count);

/// Joins the segments of all videos of `frames` into the videos of the layout, with the sound of
/// the input if the options want it and the videos have its frame rate, and the input's times of
/// the frames if that rate is variable; records this in the journal. Segments of a complete run
/// without skipped frames that may be repaired are removed, and those of a stream. Does nothing
/// when there are no videos or `frames` is empty. Keeps joined videos unless other frames are
/// skipped now or segments may have been made since (`made_segments`): those of a complete run
/// always have the same pictures, so all segments are needed to join them again. Processes wait for
/// each other. Returns why videos joined now lack sound that they should have, else "". Throws
/// Error naming the first frame without a segment.
std::string join_segments(const SequenceOptions& options, const SequenceLayout& layout,
                          const RunIdentity& identity, FrameRange frames, bool made_segments,
                          RunJournal& journal);

}  // namespace vantage
