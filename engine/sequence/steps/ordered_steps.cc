// The steps that runs do themselves, because they are in the order of the frames.
#include "engine/sequence/steps/step_list.h"

namespace vantage {
namespace {

StepBytes read_bytes(const SequenceOptions& options, const PairShape& shape) {
  (void)options;
  return {.of_run = static_cast<std::size_t>(shape.frames_kept) * shape.photograph_bytes()};
}

}  // namespace

StepEntry read_step() {
  return {.name = "read",
          .account = "read",
          .kind = WorkKind::kReading,
          .phase = StepPhase::kRead,
          .planned_bytes = read_bytes};
}

StepEntry write_step() {
  return {
      .name = "write", .account = "write", .kind = WorkKind::kWriting, .phase = StepPhase::kWrite};
}

StepEntry deliver_step() {
  return {.name = "deliver",
          .account = "deliver",
          .kind = WorkKind::kWriting,
          .phase = StepPhase::kWrite};
}

}  // namespace vantage
