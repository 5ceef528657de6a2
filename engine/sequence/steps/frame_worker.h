#pragma once

#include <memory>
#include <vector>

#include "engine/sequence/steps/busy_clock.h"
#include "engine/sequence/steps/step_accounts.h"
#include "engine/sequence/steps/step_list.h"

namespace vantage {

/// Takes frames through the steps of the list, charges and times them.
class FrameWorker {
 public:
  explicit FrameWorker(const FrameTools& tools);

  /// Runs the steps of a part of the pipeline that the frame needs; of one that is absent none, of
  /// a lead-in none of StepPhase::kEncode. Thread rule and errors: as RunStep.
  void run(StepPhase phase, FrameSlot& slot);

  /// Whether StepPhase::kCompute must be run in the order of the frames, one at a time.
  [[nodiscard]] bool computes_in_order() const { return computes_in_order_; }
  [[nodiscard]] StepAccounts& accounts() { return accounts_; }
  /// Time during which at least one frame was in a step that computes: no reading or writing.
  [[nodiscard]] double compute_seconds() const { return compute_clock_.seconds(); }
  /// Memory of matching, see StereoMatcher, and "frame before": what TemporalOptions::reuse keeps.
  void add_memory_use(MemoryUse& use) const;

 private:
  struct Step {
    const StepEntry& entry;
    std::unique_ptr<RunStep> step;
    scheduler::ProcessorAccount* account;
  };
  void take(const Step& step, FrameSlot& slot);

  bool computes_in_order_;
  StepAccounts accounts_;
  std::vector<Step> steps_;
  BusyClock compute_clock_;
};

}  // namespace vantage
