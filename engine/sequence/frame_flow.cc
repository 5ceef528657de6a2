#include "engine/sequence/frame_flow.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "engine/error.h"
#include "engine/seconds_since.h"
#include "engine/sequence/journal/commit_queue.h"

namespace vantage {

FrameFlow::FrameFlow(const SequenceOptions& options, SequenceLayout layout, const SequenceRun& run,
                     std::vector<FrameRun> work, bool writes_files, Execution& execution)
    : run_(run),
      layout_(std::move(layout)),
      cameras_{run.rectifier, run.pair_cameras, run.cameras, run.map_camera, run.poses},
      execution_(execution),
      worker_({options, layout_, run.pairs, run.frame_size, cameras_, run.shots, writes_files,
               execution}),
      feed_(std::move(work)),
      slots_(static_cast<std::size_t>(run.in_flight)) {}

scheduler::FrameOutcome FrameFlow::flow(const std::atomic<bool>* stop) {
  const auto slot_of = [this](int slot) -> std::unique_ptr<FrameSlot>& {
    return slots_[static_cast<std::size_t>(slot)];
  };
  const auto take_through = [&](StepPhase phase) {
    return [this, slot_of, phase](int slot) { take(phase, *slot_of(slot)); };
  };
  scheduler::FrameSteps steps;
  steps.read = [&](int slot) { return read(slot_of(slot)); };
  steps.prepare = take_through(StepPhase::kPrepare);
  steps.compute = take_through(StepPhase::kCompute);
  steps.encode = take_through(StepPhase::kEncode);
  steps.write = [&](int slot) { hand_over(slot_of(slot)); };
  steps.compute_in_order = worker_.computes_in_order();
  const auto skip_slot = [&](int slot, const std::exception_ptr& error) {
    if (slot_of(slot) == nullptr) {  // there was no memory for it
      std::rethrow_exception(error);
    }
    handle(*slot_of(slot), error);
    return true;
  };
  return scheduler::run_frames(execution_.executor(), run_.in_flight, steps, skip_slot, stop);
}

bool FrameFlow::read(std::unique_ptr<FrameSlot>& slot) {
  if (!may_read()) {
    return false;
  }
  const auto start = std::chrono::steady_clock::now();
  const StepEntry step = read_step();
  const scheduler::ProcessorCharge charge(worker_.accounts().of(step));
  if (!slot) {
    slot = std::make_unique<FrameSlot>();
  }
  slot->begin_frame();
  if (!feed_.next(slot->frame, slot->is_lead_in)) {
    return false;
  }
  begin(*slot);
  if (slot->frame != next_pair_) {
    run_.pairs.skip_to(slot->frame);
  }
  next_pair_ = slot->frame + 1;
  // Some containers promise a few frames more than they have; a truncated file throws.
  slot->is_absent = !run_.pairs.fetch(slot->pair);
  if (slot->is_absent && run_.pairs.is_stream()) {
    feed_.end();
    return false;
  }
  slot->times.push_back({step.name, seconds_since(start)});
  return true;
}

void FrameFlow::hand_over(std::unique_ptr<FrameSlot>& slot) {
  if (!slot->is_lead_in && !slot->is_absent) {
    latency_.leaves(slot->pair.arrival);
    if (run_.on_frame) {
      run_.on_frame(*slot);
    }
  }
  write(slot);
}

void FrameFlow::handle(FrameSlot& slot, const std::exception_ptr& error) {
  slot.files.discard();
  std::string problem;
  try {
    std::rethrow_exception(error);
  } catch (const DeliveryError&) {
    throw;
  } catch (const OutputError& output) {
    throw OutputError(fmt::format("frame {}: {}", slot.frame, output.what()));
  } catch (const UsageError&) {
    throw;
  } catch (const Error& bad_frame) {
    problem = bad_frame.what();
  }
  const std::string name = run_.pairs.describe(slot.frame);
  if (!run_.keep_going) {
    give_up(slot, name, problem);
  }
  if (!slot.is_lead_in) {  // else it is skipped when it is delivered
    latency_.leaves(std::nullopt);
    skip(slot, name, problem);
  }
}

void FrameFlow::give_up(const FrameSlot& slot, const std::string& name,
                        const std::string& problem) {
  throw Error(fmt::format("frame {} ({}): {}", slot.frame, name, problem));
}

void FrameFlow::tell_progress(int frames, double cells) {
  tell_delivered(frames);
  progress_.frames_done += frames;
  progress_.frames_total = feed_.frames_total() < kUnknownFrames ? feed_.frames_total() : 0;
  progress_.cells += cells;
  if (run_.on_progress) {
    run_.on_progress(progress_);
  }
}

void FrameFlow::add_totals(SequenceReport& report) const {
  report.in_flight = run_.in_flight;
  report.compute_seconds = worker_.compute_seconds();
  for (const std::unique_ptr<FrameSlot>& slot : slots_) {
    report.memory.add("frames in flight", slot ? held_bytes(*slot) : 0);
  }
  worker_.add_memory_use(report.memory);
  if (run_.is_live) {
    report.live = latency_.report();
    report.live->dropped = run_.pairs.dropped_pairs();
  }
}

}  // namespace vantage
