#include "engine/matching/stereo_matcher.h"

#include <fmt/format.h>

#include <utility>

#include "engine/error.h"
#include "engine/matching/match_runner.h"
#include "engine/matching/region/matched_part.h"

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
  return {.images = {{&left}, {&right, 1}}};
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

std::vector<double> places_of(const MatchCall& call) {
  std::vector<double> places;
  for (const SearchedPhotograph& image : call.images) {
    places.push_back(image.place);
  }
  return places;
}

/// A call with parts of the images of `whole`.
struct CallOfPart {
  CallOfPart(const MatchCall& whole, const ResolvedMatchOptions& options)
      : part(options,
             {whole.images.front().photograph->width(), whole.images.front().photograph->height()},
             places_of(whole), whole.reference_side),
        call(whole) {
    photographs.reserve(whole.images.size());
    for (SearchedPhotograph& image : call.images) {
      photographs.push_back(part.of(*image.photograph));
      image.photograph = &photographs.back();
    }
  }

  MatchedPart part;
  std::vector<Photograph> photographs;
  MatchCall call;
};

}  // namespace

StereoMatcher::StereoMatcher(const MatchOptions& options, Execution& execution)
    : in_force_(checked(options)),
      of_part_(options_of_part(options)),
      execution_(execution),
      runner_(std::make_unique<MatchRunner>(of_part_, execution)) {}

StereoMatcher::~StereoMatcher() = default;

void StereoMatcher::match(const Photograph& left, const Photograph& right,
                          const MatchRequest& request, DisparityMaps& maps,
                          MatchReport* report) const {
  const MatchCall call = pair_call(left, right);
  require_usable(request.prior, left);
  if (!request.prior.empty() && in_force_.disparities_y) {
    throw UsageError("there is a prior beside disparities-y, expected a search along rows only");
  }
  run(call, request, maps, report);
}

void StereoMatcher::match_several(const Photograph& reference, std::span<const OtherView> others,
                                  const MatchRequest& request, DisparityMaps& maps,
                                  MatchReport* report) const {
  const MatchCall call = several_call(reference, others);
  require_usable(request.prior, reference);
  run(call, request, maps, report);
}

void StereoMatcher::run(const MatchCall& call, const MatchRequest& request, DisparityMaps& maps,
                        MatchReport* report) const {
  if (!in_force_.is_of_part()) {
    runner_->run(call, request, maps, report);
    return;
  }
  if (!request.volumes.empty()) {
    throw UsageError("there is a volume with roi or scale, expected one of whole images");
  }
  const CallOfPart part(call, in_force_);
  const DisparityMap left_prior_px = part.part.of_prior(request.prior.left_px);
  const DisparityMap right_prior_px = part.part.of_prior(request.prior.right_px);
  MatchRequest request_of_part = request;
  request_of_part.prior.left_px = left_prior_px.view();
  request_of_part.prior.right_px = right_prior_px.view();
  DisparityMaps found;
  runner_->run(part.call, request_of_part, found, report);
  const bool is_left_for_later =
      request.previous != nullptr && request.deferred != nullptr && request.deferred->is_pending;
  const bool is_pair = call.baselines.empty();
  for (const Side side : {Side::kLeft, Side::kRight}) {
    if (!is_left_for_later && (is_pair ? request.wants(side) : side == call.reference_side)) {
      const std::size_t image = is_pair ? index_of(side) : 0;
      part.part.bring_back(found.of(side), image, *call.images[image].photograph, maps.of(side));
    }
  }
}

std::vector<scheduler::ChainPlan> StereoMatcher::plans(
    const MatchCall& call, std::span<const ExecutionOptions> executions) const {
  return in_force_.is_of_part() ? runner_->plans(CallOfPart(call, in_force_).call, executions)
                                : runner_->plans(call, executions);
}

scheduler::ChainPlan StereoMatcher::plan(const Photograph& left, const Photograph& right) const {
  return plans(left, right, {&execution_.options(), 1}).front();
}

std::vector<scheduler::ChainPlan> StereoMatcher::plans(
    const Photograph& left, const Photograph& right,
    std::span<const ExecutionOptions> executions) const {
  return plans(pair_call(left, right), executions);
}

scheduler::ChainPlan StereoMatcher::plan_several(const Photograph& reference,
                                                 std::span<const OtherView> others) const {
  return plans(several_call(reference, others), {&execution_.options(), 1}).front();
}

void StereoMatcher::add_memory_use(MemoryUse& use) const { runner_->add_memory_use(use); }

}  // namespace vantage
