#include "scheduler/frame_pipeline.h"

#include <vector>

namespace vantage::scheduler {

FrameOutcome run_frames(Executor& executor, int in_flight, const FrameSteps& steps,
                        const SkipFrame& skip, const std::atomic<bool>* stop) {
  FrameOutcome outcome;
  std::vector<std::exception_ptr> slot_error(static_cast<std::size_t>(in_flight));
  std::exception_ptr last_error;    // only the writing step touches it
  std::atomic<bool> failed{false};  // the run has ended at a frame: later frames do not matter
  bool read_failed = false;         // only the reading step touches it

  const auto error_of = [&](int slot) -> std::exception_ptr& {
    return slot_error[static_cast<std::size_t>(slot)];
  };
  const auto run_step = [&](const std::function<void(int)>& step, int slot) {
    if (failed.load() || error_of(slot)) {
      return;
    }
    try {
      step(slot);
    } catch (...) {
      error_of(slot) = std::current_exception();
    }
  };

  FrameSteps guarded;
  guarded.compute_in_order = steps.compute_in_order;
  guarded.read = [&](int slot) {
    if (failed.load() || (read_failed && !skip)) {
      return false;
    }
    if (stop != nullptr && stop->load()) {
      outcome.interrupted = true;
      return false;
    }
    error_of(slot) = nullptr;
    try {
      return steps.read(slot);
    } catch (...) {
      error_of(slot) = std::current_exception();
      read_failed = true;
      return true;
    }
  };
  guarded.prepare = [&](int slot) { run_step(steps.prepare, slot); };
  guarded.compute = [&](int slot) { run_step(steps.compute, slot); };
  guarded.encode = [&](int slot) { run_step(steps.encode, slot); };
  guarded.write = [&](int slot) {
    if (last_error) {
      return;
    }
    run_step(steps.write, slot);
    if (!error_of(slot)) {
      ++outcome.frames_written;
      return;
    }
    try {
      if (skip && skip(slot, error_of(slot))) {
        return;
      }
      last_error = error_of(slot);
    } catch (...) {
      last_error = std::current_exception();
    }
    failed.store(true);
  };
  executor.run_frame_steps(in_flight, guarded);

  if (last_error) {
    std::rethrow_exception(last_error);
  }
  return outcome;
}

}  // namespace vantage::scheduler
