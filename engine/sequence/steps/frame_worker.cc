#include "engine/sequence/steps/frame_worker.h"

#include <optional>

#include "engine/sequence/steps/timed_part.h"

namespace vantage {

FrameWorker::FrameWorker(const FrameTools& tools)
    : computes_in_order_(tools.options.temporal.uses_past()) {
  for (const StepEntry& entry : frame_steps()) {
    if (entry.make != nullptr) {
      steps_.push_back({entry, entry.make(tools), accounts_.of(entry)});
    }
  }
}

void FrameWorker::run(StepPhase phase, FrameSlot& slot) {
  if (slot.is_absent) {
    return;
  }
  for (const Step& step : steps_) {
    if (step.entry.phase == phase && !(slot.is_lead_in && phase == StepPhase::kEncode) &&
        step.step->is_needed(slot)) {
      take(step, slot);
    }
  }
  if (phase == StepPhase::kEncode) {
    slot.deferred = {};  // ahead of its matcher
    slot.shot.reset();
  }
}

void FrameWorker::take(const Step& step, FrameSlot& slot) {
  std::optional<BusyClock::Activity> activity;
  if (step.entry.kind == WorkKind::kComputing) {
    activity.emplace(compute_clock_);
  }
  std::optional<TimedPart> part;
  if (!step.entry.name.empty()) {
    part.emplace(slot, step.entry.name);
  }
  const scheduler::ProcessorCharge charge(step.account);
  step.step->run(slot);
}

void FrameWorker::add_memory_use(MemoryUse& use) const {
  for (const Step& step : steps_) {
    step.step->add_memory_use(use);
  }
}

}  // namespace vantage
