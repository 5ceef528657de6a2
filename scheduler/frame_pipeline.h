#pragma once

#include <atomic>
#include <exception>
#include <functional>

#include "scheduler/executor.h"

namespace vantage::scheduler {

/// How a pipeline of frames ended.
struct FrameOutcome {
  int frames_written = 0;
  bool interrupted = false;  ///< `stop` was raised before the source ended
};

/// Decides about a frame that failed, in the order of the frames and never concurrently with
/// FrameSteps::write: true if the run continues without it.
using SkipFrame = std::function<bool(int slot, const std::exception_ptr& error)>;

/// Runs `steps`, which may throw, over all frames with at most `in_flight` of them at a time.
///
/// A frame that fails in any step is offered to `skip` in its turn. Without `skip`, or if `skip`
/// declines or throws, the frame ends the run: every frame before it is written, none after it is,
/// and its exception is rethrown when all steps have ended. A frame whose read() threw is treated
/// like any other, so read() must be callable after it, at least to report the end.
/// Raising `stop` (such as from a signal handler) stops reading; frames in flight are written.
FrameOutcome run_frames(Executor& executor, int in_flight, const FrameSteps& steps,
                        const SkipFrame& skip = {}, const std::atomic<bool>* stop = nullptr);

}  // namespace vantage::scheduler
