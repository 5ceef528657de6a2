#pragma once

#include "engine/matching/options/match_options.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/sequence/run_journal.h"
#include "engine/sequence/sequence_layout.h"
#include "engine/sequence/sequence_options.h"

namespace vantage {

/// Whether videos show new views, alone or in stereo pictures.
bool videos_show_views(const SequenceOptions& options);

/// Whether the files of a frame hold the maps that its pictures in videos, and what is measured of
/// it, are made of. Masks of what was filled are in no map, and a temporal prior is made of them.
bool maps_are_stored(const SequenceOptions& options);

/// Reads the reference's map, and with `needs_both` the right one beside it, from the files of
/// `record`. False when one is not as it was written.
bool read_stored_maps(const SequenceLayout& layout, const FrameRecord& record, Side reference,
                      bool needs_both, DisparityMaps& maps);

}  // namespace vantage
