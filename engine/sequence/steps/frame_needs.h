#pragma once

#include <cstddef>

#include "engine/matching/stereo_matcher.h"
#include "engine/sequence/options/sequence_options.h"
#include "engine/sequence/pairs/pair_source.h"
#include "engine/sequence/steps/frame_slot.h"

namespace vantage {

// What the options of a run need of its frames, where several steps have to know.

/// What is matched.
MatchRequest match_request(const SequenceOptions& options);

/// Whether videos show new views, alone or in stereo pictures.
bool videos_show_views(const SequenceOptions& options);

/// Whether any result of the frame needs new views: of a stored one, those of the videos.
bool needs_views(const SequenceOptions& options, const FrameSlot& slot);

/// Whether views of rectified frames use the colours of the original photographs. False for the
/// book's warp, which moves pixels of rectified images.
bool views_show_photographs(const SequenceOptions& options);

/// Size of a new view of images of size `images`: that of its cameras if they have one.
ImageExtent extent_of(const ViewPath& view, ImageExtent images);

/// Whether a frame needs an output: of a stored one, only videos do.
bool wants(const SequenceOptions& options, const FrameSlot& slot, SequenceOutput output);

/// What is kept of the frame before, bytes per pixel of an image: its levels before and now,
/// differences and mask; two maps.
inline constexpr std::size_t kPastSideBytes = 5 + 2 * sizeof(float);

}  // namespace vantage
