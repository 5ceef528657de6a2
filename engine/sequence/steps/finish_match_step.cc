#include <atomic>

#include "engine/sequence/steps/frame_needs.h"
#include "engine/sequence/steps/step_list.h"
#include "engine/sequence/steps/timed_part.h"

namespace vantage {
namespace {

/// A look takes up to a tenth of the time of a match; whether frames are cut off is known after a
/// few.
constexpr int kMaxLooksBeyond = 4;

/// Makes the maps that could wait, and looks at the first few frames for which the range may be too
/// narrow.
class FinishMatchStep final : public RunStep {
 public:
  explicit FinishMatchStep(const FrameTools& tools)
      : request_(match_request(tools.options)),
        checks_range_(tools.options.baselines.empty() &&
                      tools.options.unrectified == UnrectifiedSearch::kNone),
        execution_(tools.execution) {}

  [[nodiscard]] bool is_needed(const FrameSlot& slot) const override {
    return slot.shot != nullptr;
  }

  void run(FrameSlot& slot) override {
    if (slot.deferred.is_pending) {
      MatchRequest request = request_;
      request.deferred = &slot.deferred;
      slot.shot->matcher.match(*slot.left, *slot.right, request, slot.maps, &slot.match);
    }
    if (checks_range_) {
      check_range(slot, slot.shot->options);
    }
  }

 private:
  void check_range(FrameSlot& slot, const MatchOptions& options) {
    const MatchesAtEnds matches = matches_at_ends(slot.maps, options);
    slot.may_be_cut = may_be_cut(matches, options, false);
    if (slot.may_be_cut && looks_beyond_++ < kMaxLooksBeyond) {
      const TimedPart part(slot, "range check");
      slot.cut = look_beyond(matches, *slot.left, *slot.right, options, execution_);
    }
  }

  MatchRequest request_;
  bool checks_range_;
  Execution& execution_;
  std::atomic<int> looks_beyond_ = 0;
};

}  // namespace

StepEntry finish_match_step() {
  return {.name = "",
          .account = "match",
          .phase = StepPhase::kEncode,
          .make = make_step<FinishMatchStep>};
}

}  // namespace vantage
