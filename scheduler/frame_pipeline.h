#pragma once

#include <atomic>
#include <exception>
#include <functional>

#include "scheduler/executor.h"

namespace vantage::scheduler {

/// How a pipeline of frames ended.
struct FrameOutcome {
  int frames_written = 0;
  int frames_skipped = 0;
  bool interrupted = false;  ///< `stop` was raised before the source ended
};

/// Decides about a frame that failed, in the order of the frames and never concurrently with
/// FrameSteps::write: true if the run shall go on without it.
using SkipFrame = std::function<bool(int slot, const std::exception_ptr& error)>;

/// Runs `steps`, which may throw, over all frames with at most `in_flight` of them under way.
///
/// A frame that fails, in whatever step, is offered to `skip` in its turn; without `skip`, or if
/// that declines or throws, the frame ends the run: every frame before it is written, none after it
/// is, and its exception is rethrown here once nothing runs any more. A frame whose reading threw
/// takes part like others, so reading must be able to go on behind it, if only by telling the end.
/// Raising `stop` (from a signal handler, say) reads no further frame and writes those under way.
FrameOutcome run_frames(Executor& executor, int in_flight, const FrameSteps& steps,
                        const SkipFrame& skip = {}, const std::atomic<bool>* stop = nullptr);

}  // namespace vantage::scheduler
