#pragma once

#include <cstddef>
#include <optional>

#include "engine/execution.h"
#include "engine/sequence/frame_worker.h"
#include "engine/sequence/sequence_options.h"
#include "scheduler/strip_plan.h"

namespace vantage {

/// What a run takes of memory, as planned.
struct MemoryPlan {
  int in_flight = 1;
  /// For what the iterations of one map store between passes and the scratch of all threads;
  /// ExecutionOptions::chain_memory_bytes of the run.
  std::size_t chain_bytes = 0;
  std::size_t frame_bytes = 0;  ///< images, maps, views and files of a frame under way
  std::size_t total_bytes = 0;  ///< of the whole process, most at any one time
  scheduler::ChainPlan chain;   ///< of one map
};

/// What the pairs of a run are like, as the first one tells.
struct PairShape {
  ImageExtent source;  ///< before rectification, which keeps the size
  int channels = 1;
  int bytes_per_value = 1;
  bool is_video = false;                      ///< they come from videos
  bool is_rectified_here = false;             ///< a calibration is applied
  int frames_kept = 0;                        ///< PairSource::frames_kept()
  int pair_count = 1;                         ///< of the input
  std::optional<RectifiedPair> cameras = {};  ///< where the pairs are calibrated
};

struct MemoryRequest {
  std::optional<int> in_flight;             ///< as the user wants it; default: threads + 2
  std::optional<std::size_t> memory_bytes;  ///< not to be exceeded; default: no limit
};

/// Frames in flight where neither the user nor memory says anything.
int default_frames_in_flight(int threads);

/// Chooses how many frames are under way and what each may take, within the request: fewer frames
/// first, then less for the iterations. `left` and `right` are the first pair, ready to be matched.
/// Throws Error when one frame does not fit, naming what it takes; naming the frame, for views that
/// cannot be rendered.
MemoryPlan plan_memory(const SequenceOptions& options, const MemoryRequest& request,
                       const PairShape& shape, const Photograph& left, const Photograph& right,
                       const ExecutionOptions& execution);

}  // namespace vantage
