#include "engine/matching/stereo_matcher.h"

#include <fmt/format.h>

#include "engine/error.h"
#include "engine/matching/match_runner.h"

namespace vantage {
namespace {

ResolvedMatchOptions checked(const MatchOptions& options) {
  options.validate();
  if (options.disparities_auto || options.disparities_y_auto) {
    throw UsageError("disparities is auto, expected the range that the images suggest");
  }
  return options.in_force();
}

MatchCall pair_call(const Photograph& left, const Photograph& right) {
  require_equal_sizes(left, "left image", right, "right image");
  return {.images = {{&left}, {&right}}};
}

MatchCall several_call(const Photograph& reference, std::span<const OtherView> others) {
  require_different_baselines(others);
  MatchCall call{.images = {{&reference}}};
  for (std::size_t k = 0; k < others.size(); ++k) {
    require_equal_sizes(reference, "reference image", *others[k].photograph,
                        fmt::format("image {}", k + 1));
    call.images.push_back({others[k].photograph, others[k].baseline / others.front().baseline});
    call.baselines.push_back(others[k].baseline);
  }
  call.reference_side = others.front().baseline > 0 ? Side::kLeft : Side::kRight;
  return call;
}

}  // namespace

StereoMatcher::StereoMatcher(const MatchOptions& options, Execution& execution)
    : in_force_(checked(options)),
      execution_(execution),
      runner_(std::make_unique<MatchRunner>(in_force_, execution)) {}

StereoMatcher::~StereoMatcher() = default;

void StereoMatcher::match(const Photograph& left, const Photograph& right,
                          const MatchRequest& request, DisparityMaps& maps,
                          MatchReport* report) const {
  const MatchCall call = pair_call(left, right);
  require_usable(request.prior, left);
  if (!request.prior.empty() && in_force_.disparities_y) {
    throw UsageError("there is a prior beside disparities-y, expected a search along rows only");
  }
  runner_->run(call, request, maps, report);
}

void StereoMatcher::match_several(const Photograph& reference, std::span<const OtherView> others,
                                  const MatchRequest& request, DisparityMaps& maps,
                                  MatchReport* report) const {
  const MatchCall call = several_call(reference, others);
  require_usable(request.prior, reference);
  runner_->run(call, request, maps, report);
}

scheduler::ChainPlan StereoMatcher::plan(const Photograph& left, const Photograph& right) const {
  return plans(left, right, {&execution_.options(), 1}).front();
}

std::vector<scheduler::ChainPlan> StereoMatcher::plans(
    const Photograph& left, const Photograph& right,
    std::span<const ExecutionOptions> executions) const {
  return runner_->plans(pair_call(left, right), executions);
}

scheduler::ChainPlan StereoMatcher::plan_several(const Photograph& reference,
                                                 std::span<const OtherView> others) const {
  return runner_->plans(several_call(reference, others), {&execution_.options(), 1}).front();
}

void StereoMatcher::add_memory_use(MemoryUse& use) const { runner_->add_memory_use(use); }

}  // namespace vantage
