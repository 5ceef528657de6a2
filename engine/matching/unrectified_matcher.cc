#include "engine/matching/unrectified_matcher.h"

#include <utility>

#include "engine/error.h"
#include "engine/matching/match_runner.h"

namespace vantage {
namespace {

/// Without what works on two images whose rows correspond.
ResolvedMatchOptions along_lines(const MatchOptions& options) {
  options.validate();
  if (options.disparities_auto) {
    throw UsageError("disparities is auto, expected the range that the images suggest");
  }
  ResolvedMatchOptions resolved = options.in_force();
  if (resolved.is_of_part()) {
    throw UsageError("roi and scale cannot be used along epipolar lines, expected whole images");
  }
  require_abilities(search_of(resolved, {.along_lines = true}).abilities, resolved);
  resolved.parameters.window_levels = 0;
  return resolved;
}

}  // namespace

void UnrectifiedMatcher::validate(MatchOptions options) {
  options.disparities_auto = false;
  (void)along_lines(options);
}

UnrectifiedMatcher::UnrectifiedMatcher(const MatchOptions& options, const Rectifier& rectifier,
                                       Execution& execution)
    : UnrectifiedMatcher(options, epipolar_grids(rectifier, execution), execution) {}

UnrectifiedMatcher::UnrectifiedMatcher(const MatchOptions& options,
                                       std::shared_ptr<const EpipolarGrids> grids,
                                       Execution& execution)
    : in_force_(along_lines(options)),
      grids_(std::move(grids)),
      runner_(std::make_unique<MatchRunner>(in_force_, execution)) {}

UnrectifiedMatcher::~UnrectifiedMatcher() = default;

void UnrectifiedMatcher::match(const Photograph& left, const Photograph& right,
                               const UnrectifiedRequest& request, DisparityMaps& maps,
                               MatchReport* report) const {
  require_equal_sizes(left, "left image", right, "right image");
  runner_->run({.images = {{&left}, {&right}}, .grids = grids_.get()},
               {.left = request.left, .right = request.right, .probability = request.probability},
               maps, report);
}

}  // namespace vantage
