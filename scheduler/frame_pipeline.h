#pragma once

#include <atomic>

#include "scheduler/executor.h"

namespace vantage::scheduler {

/// How a pipeline of frames ended.
struct FrameOutcome {
  int frames_written = 0;
  bool interrupted = false;  ///< `stop` was raised before the source ended
};

/// Runs `steps`, which may throw, over all frames with at most `in_flight` of them under way.
///
/// The first frame that fails, in the order of the frames and whatever step it fails in, ends the
/// run: every frame before it is written, none after it is, and its exception is rethrown here once
/// nothing runs any more. Raising `stop` (from a signal handler, say) reads no further frame and
/// writes those under way.
FrameOutcome run_frames(Executor& executor, int in_flight, const FrameSteps& steps,
                        const std::atomic<bool>* stop = nullptr);

}  // namespace vantage::scheduler
