#pragma once

#include "engine/image/photograph.h"
#include "engine/io/video/libav.h"
#include "engine/io/video/video_io.h"
#include "engine/sequence/options/sequence_options.h"

namespace vantage {

/// How the video of an output is encoded.
VideoEncoding encoding_of(const SequenceOptions& options, SequenceOutput output);

/// Frames that wait for the encoders of one video, at most.
constexpr int max_frames_waiting(int threads) { return 16 + 3 * threads; }

}  // namespace vantage
