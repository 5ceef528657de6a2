#include "scheduler/frame_pipeline.h"

#include <exception>
#include <vector>

namespace vantage::scheduler {

FrameOutcome run_frames(Executor& executor, int in_flight, const FrameSteps& steps,
                        const std::atomic<bool>* stop) {
  FrameOutcome outcome;
  std::vector<std::exception_ptr> slot_error(static_cast<std::size_t>(in_flight));
  std::exception_ptr read_error;
  std::exception_ptr first_error;   // only the writing step touches it
  std::atomic<bool> failed{false};  // tells the reading step to end

  FrameSteps guarded;
  guarded.read = [&](int slot) {
    if (failed.load()) {
      return false;
    }
    if (stop != nullptr && stop->load()) {
      outcome.interrupted = true;
      return false;
    }
    slot_error[static_cast<std::size_t>(slot)] = nullptr;
    try {
      return steps.read(slot);
    } catch (...) {
      read_error = std::current_exception();
      return false;
    }
  };
  guarded.compute = [&](int slot) {
    if (failed.load()) {
      return;
    }
    try {
      steps.compute(slot);
    } catch (...) {
      slot_error[static_cast<std::size_t>(slot)] = std::current_exception();
    }
  };
  guarded.write = [&](int slot) {
    if (first_error) {
      return;
    }
    first_error = slot_error[static_cast<std::size_t>(slot)];
    if (!first_error) {
      try {
        steps.write(slot);
        ++outcome.frames_written;
      } catch (...) {
        first_error = std::current_exception();
      }
    }
    if (first_error) {
      failed.store(true);
    }
  };
  executor.run_frame_steps(in_flight, guarded);

  if (first_error) {
    std::rethrow_exception(first_error);
  }
  if (read_error) {
    std::rethrow_exception(read_error);
  }
  return outcome;
}

}  // namespace vantage::scheduler
