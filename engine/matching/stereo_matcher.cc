#include "engine/matching/stereo_matcher.h"

#include <fmt/format.h>

#include <chrono>

#include "engine/error.h"
#include "engine/matching/match_chain.h"
#include "engine/refinement/refinement.h"
#include "scheduler/strip_pipeline.h"

namespace vantage {
namespace {

/// Appends the time since the last call (or construction) to a report.
class StageClock {
 public:
  explicit StageClock(MatchReport& report) : report_(report) {}
  void record(std::string_view name) {
    const Clock::time_point now = Clock::now();
    report_.stages.push_back({name, std::chrono::duration<double>(now - last_).count()});
    last_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  MatchReport& report_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace

StereoMatcher::StereoMatcher(const MatchOptions& options, Execution& execution)
    : options_(options), execution_(execution) {
  options_.validate();
}

void StereoMatcher::match(const Photograph& left, const Photograph& right,
                          const MatchRequest& request, DisparityMaps& maps,
                          MatchReport* report) const {
  if (left.width() != right.width() || left.height() != right.height()) {
    throw Error(fmt::format("left image is {}x{} but right image is {}x{}, expected equal sizes",
                            left.width(), left.height(), right.width(), right.height()));
  }
  MatchReport own_report;
  MatchReport& times = report != nullptr ? *report : own_report;
  times = {};
  StageClock clock(times);
  const PlanesNeeded needed{request.left || !options_.raw, request.right || !options_.raw};
  const int window_px = options_.resolved().window_px;
  const auto pair = prepared_pairs_.borrow();
  prepare_pair(left, right,
               candidate_geometry(options_, Reference::kLeft, left.width(), left.height()),
               window_px * window_px, needed, execution_, *pair);
  clock.record("prepare");
  maps.left.resize(0, 0);
  maps.right.resize(0, 0);
  if (needed.left_reference) {
    maps.left.resize(left.width(), left.height());
    compute_map(Reference::kLeft, *pair, maps.left, times);
    clock.record("match left");
  }
  if (needed.right_reference) {
    maps.right.resize(left.width(), left.height());
    compute_map(Reference::kRight, *pair, maps.right, times);
    clock.record("match right");
  }

  if (options_.raw) {
    if (request.unmatched) {
      mark_unknown(maps.left.view(), execution_, maps.left_unmatched);
      mark_unknown(maps.right.view(), execution_, maps.right_unmatched);
    }
    return;
  }
  cross_check(maps.left.view(), maps.right.view(), options_.cross_check_or_default(), execution_,
              maps.left_unmatched, maps.right_unmatched);
  clock.record("cross-check");
  if (options_.refinement.speckle_size_px > 1) {
    execution_.executor().parallel_for(2, [&](int side) {
      const auto work = speckle_works_.borrow();
      const DisparityMap& map = side == 0 ? maps.left : maps.right;
      mark_speckles(map.view(), options_.refinement.speckle_size_px, *work,
                    side == 0 ? maps.left_unmatched : maps.right_unmatched);
    });
    clock.record("speckles");
  }
  fill_unmatched(maps.left_unmatched, MapSide::kLeft, execution_, maps.left);
  fill_unmatched(maps.right_unmatched, MapSide::kRight, execution_, maps.right);
  clock.record("fill");
}

void StereoMatcher::compute_map(Reference reference, const PreparedPair& pair, DisparityMap& map_px,
                                MatchReport& report) const {
  const auto geometry = candidate_geometry(options_, reference, map_px.width(), map_px.height());
  const MatchChain chain(options_, geometry, pair, map_px.view());
  scheduler::PlanRequest request;
  request.threads = execution_.executor().thread_count();
  request.strip_columns = execution_.options().strip_width_px;
  request.band_rows = execution_.options().band_height_px;
  report.plan = scheduler::plan_chain(chain.stages(), execution_.machine(), request);
  scheduler::run_strips(chain.stages(), report.plan, execution_.executor(), execution_.scratch());
  report.cells +=
      static_cast<double>(map_px.width()) * map_px.height() * options_.disparities.count();
}

}  // namespace vantage
