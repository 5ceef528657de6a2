#pragma once

#include <string_view>

#include "engine/sequence/sequence_runner.h"
#include "engine/sequence/steps/frame_slot.h"
#include "engine/sequence/steps/step_accounts.h"

namespace vantage {

/// Adds a frame that is written to the totals of its run.
void add_frame(SequenceReport& report, const FrameSlot& slot);

/// Processor time by step, and the share of `wall_seconds` that `threads` threads were busy;
/// `all_seconds`: of the whole process.
void add_processor_time(SequenceReport& report, const StepAccounts& accounts, double all_seconds,
                        double wall_seconds, int threads);

}  // namespace vantage
