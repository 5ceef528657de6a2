#pragma once

#include <string>

#include "engine/sequence/delivered_frames.h"
#include "engine/sequence/flicker.h"
#include "engine/sequence/frame_range.h"
#include "engine/sequence/run_journal.h"
#include "engine/sequence/sequence_layout.h"
#include "engine/sequence/sequence_options.h"

namespace vantage {

/// The frames that the delivered ones cover from the first to the last; empty when there are none
/// or when there are gaps between them.
FrameRange contiguous_frames(const DeliveredFrames& delivered, int frame_count);

/// Joins the segments of all videos of `frames` into the videos of the layout, with the sound of
/// the input where the options want it and the videos have its frame rate, and says so in the
/// journal. Segments of a run that is complete, without skipped frames that may be repaired, are
/// removed. Does nothing when there are no videos or `frames` is empty, and leaves joined videos
/// alone unless other frames are skipped now or segments may have been made since
/// (`made_segments`): those of a complete run have the same pictures whenever they are made, so it
/// takes all of them to join them anew. Processes
/// wait for each other. Returns why videos joined now are without the sound they should have, ""
/// where they are not. Throws Error naming the first frame that no segment has.
std::string join_segments(const SequenceOptions& options, const SequenceLayout& layout,
                          const RunIdentity& identity, FrameRange frames, bool made_segments,
                          RunJournal& journal);

/// Flicker of all delivered frames.
FlickerSums total_flicker(const DeliveredFrames& delivered);

}  // namespace vantage
