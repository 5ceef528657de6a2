#pragma once

#include "engine/matching/options/match_options.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/sequence/journal/run_journal.h"
#include "engine/sequence/options/sequence_layout.h"
#include "engine/sequence/options/sequence_options.h"

namespace vantage {

/// Whether videos show new views, alone or in stereo pictures.
bool videos_show_views(const SequenceOptions& options);

/// Whether the files of a frame hold the maps that its pictures in videos, and its flicker
/// measurement, are made from. False if more is needed than maps contain: masks of filled pixels,
/// or what later frames take from this one.
bool maps_are_stored(const SequenceOptions& options);

/// Reads the reference's map, and with `needs_both` also the right one, from the files of `record`.
/// False if one has changed since it was written.
bool read_stored_maps(const SequenceLayout& layout, const FrameRecord& record, Side reference,
                      bool needs_both, DisparityMaps& maps);

}  // namespace vantage
