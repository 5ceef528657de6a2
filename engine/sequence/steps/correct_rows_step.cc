#include <fmt/format.h>

#include "engine/rectification/rows/row_correction.h"
#include "engine/sequence/steps/frame_needs.h"
#include "engine/sequence/steps/step_list.h"

namespace vantage {
namespace {

bool needs_correction(const FrameTools& tools, const FrameSlot& slot) {
  (void)slot;
  return tools.options.corrects_rows();
}

void find_own_rows(const FrameTools& tools, FrameSlot& slot) {
  const RowCheck check = check_rows(*slot.left, *slot.right, &tools.execution);
  if (check.pays()) {
    slot.rows = check.rows->field;
    slot.pair.remarks.push_back(fmt::format("rows: {}; corrected", row_text(*check.rows)));
  }
}

void correct(const FrameTools& tools, FrameSlot& slot) {
  if (tools.options.corrects_rows_per_pair) {
    find_own_rows(tools, slot);
  } else {
    slot.rows = tools.options.rows.at(slot.pair.index);
  }
  if (!slot.rows) {
    return;
  }
  correct_rows(*slot.right, *slot.rows, slot.corrected, tools.execution);
  slot.right = &slot.corrected;
  const Rectifier* const rectifier = tools.cameras.rectifier_of(slot);
  if (rectifier != nullptr && views_show_photographs(tools.options)) {
    Photograph photograph;
    correct_photograph(slot.pair.right, *slot.rows, *rectifier, photograph, tools.execution);
    slot.pair.right = std::move(photograph);
  }
}

StepBytes correction_bytes(const SequenceOptions& options, const PairShape& shape) {
  return {.of_frame = options.corrects_rows() ? shape.photograph_bytes() : 0,
          .of_work =
              options.corrects_rows() && shape.is_rectified_here && views_show_photographs(options)
                  ? shape.photograph_bytes()
                  : 0};
}

}  // namespace

StepEntry correct_rows_step() {
  return {.name = "rows",
          .account = "rectify",
          .phase = StepPhase::kPrepare,
          .make = make_step<needs_correction, correct>,
          .planned_bytes = correction_bytes,
          .held_bytes = [](const FrameSlot& slot) { return held_bytes(slot.corrected); }};
}

}  // namespace vantage
