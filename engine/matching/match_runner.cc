#include "engine/matching/match_runner.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/error.h"
#include "engine/image/content_hash.h"
#include "engine/image/left_out.h"
#include "engine/matching/worth/map_confidence.h"

namespace vantage {
namespace {

/// Throws UsageError where maps cannot keep anything from the pair before.
void require_reuse(const SearchAbilities& abilities, const SearchJob& job) {
  std::string_view obstacle = job.request.uses_prior()       ? "a prior"
                              : !job.request.volumes.empty() ? "volumes"
                                                             : reuse_obstacle(job.options);
  if (obstacle.empty() && !abilities.reuse) {
    obstacle = abilities.name;
  }
  if (!obstacle.empty()) {
    throw UsageError(
        fmt::format("there are maps of the pair before with {}, expected none", obstacle));
  }
}

/// Sets what is computed of each image's map: the map if it is requested or needed to check the
/// other one; what the other one is checked against.
void set_needs(const SearchAbilities& abilities, SearchJob& job) {
  const bool has_check_maps = job.is_checked() && abilities.check_maps &&
                              job.plan.levels.has_check_map && !job.options.disparities_y &&
                              job.options.refinement->edge_snapping_px == 0;
  for (MapTask& task : job.tasks) {
    const bool is_other_wanted =
        job.tasks.size() > 1 && job.task_of(other_side(task.side)).is_result;
    task.need = {.whole = task.is_result || job.is_checked() || job.is_symmetric(),
                 .check = has_check_maps && is_other_wanted,
                 .check_is_only = has_check_maps && !task.is_result};
  }
}

std::string note_of(const FoundNoise& noise, const NoiseFilter& filter) {
  const std::string what = noise.kind == NoiseKind::kCodec
                               ? "blocks of a lossy codec"
                               : fmt::format("{:.1f} grey levels", noise.grey_levels);
  return fmt::format("noise: {}; images are compared smoothed by {:.0f} px", what, filter.sigma_px);
}

}  // namespace

MatchRunner::MatchRunner(const ResolvedMatchOptions& options, Execution& execution)
    : options_(options), execution_(execution) {
  for (std::size_t kind = 0; kind < kNoiseKinds; ++kind) {
    options_of_[kind] = options;
    options_of_[kind].parameters = options.parameters_of[kind].value_or(options.parameters);
  }
}

FoundNoise MatchRunner::noise_of(const MatchCall& call) {
  if (options_.noise) {
    const NoiseKind kind = *options_.noise > 0 ? NoiseKind::kSensor : NoiseKind::kNone;
    return {.kind = kind, .grey_levels = *options_.noise};
  }
  std::vector<const Photograph*> photographs;
  for (const SearchedPhotograph& image : call.images) {
    photographs.push_back(image.photograph);
  }
  const bool has_rows = call.baselines.empty() && call.grids == nullptr;
  return find_noise(photographs, has_rows ? std::optional(options_.disparities) : std::nullopt,
                    execution_);
}

void MatchRunner::smooth(const NoiseFilter& filter, std::vector<SmoothedPhotograph>& smoothed,
                         MatchCall& call) {
  smoothed.resize(call.images.size());
  for (std::size_t i = 0; i < call.images.size(); ++i) {
    const Photograph*& photograph = call.images[i].photograph;
    const bool is_colour =
        options_.parameters.colour == ColourUse::kChannels && photograph->channels() >= 3;
    photograph = &smoothed[i].make(*photograph, is_colour ? 3 : 1, filter, execution_);
  }
}

/// keeps_costs: for the pair after it.
MatchSize MatchRunner::size_of(const MatchCall& call, bool keeps_costs) const {
  const Photograph& image = *call.images.front().photograph;
  return {.image = {image.width(), image.height()},
          .channels = image.channels(),
          .baselines = call.baselines,
          .along_lines = call.grids != nullptr,
          .level_bytes =
              keeps_costs ? kWithoutBands
                          : execution_.options().level_memory_bytes.value_or(kDefaultLevelBytes)};
}

SearchJob MatchRunner::job_of(const ResolvedMatchOptions& options, const MatchCall& call,
                              const MatchRequest& request, DisparityMaps& maps, MatchReport& report,
                              StageClock& clock) const {
  return {.options = options,
          .execution = execution_,
          .request = request,
          .maps = maps,
          .report = report,
          .clock = clock,
          .images = call.images,
          .reference_side = call.reference_side,
          .grids = call.grids,
          .parameters = options.parameters};
}

void MatchRunner::run(const MatchCall& given, const MatchRequest& request, DisparityMaps& maps,
                      MatchReport* report) {
  MatchReport own_report;
  MatchReport& times = report != nullptr ? *report : own_report;
  const bool is_resumed =
      request.previous == nullptr && request.deferred != nullptr && request.deferred->is_pending;
  if (!is_resumed) {
    times = {};
  }
  StageClock clock(times);
  clock.start("noise");
  times.noise = noise_of(given);
  if (!is_resumed && given.images.size() == 2 &&
      have_same_pixels(*given.images[0].photograph, *given.images[1].photograph)) {
    times.warn("images", "left and right are the same picture");
  }
  const NoiseFilter filter = filter_of(times.noise);
  const auto smoothed = smoothed_.borrow();
  MatchCall call = given;
  if (filter.smooths()) {
    smooth(filter, *smoothed, call);
    if (!is_resumed) {
      times.note("noise", note_of(times.noise, filter));
    }
  }
  const auto& options = options_of_[static_cast<std::size_t>(times.noise.kind)];
  SearchJob job = job_of(options, call, request, maps, times, clock);
  const MatchSize size = size_of(call, request.previous != nullptr);
  const SearchEntry& entry = search_of(options, size);
  if (request.previous != nullptr) {
    require_reuse(entry.abilities, job);
  }
  require_abilities(entry.abilities, options, request);
  clock.start("prepare");
  const std::string obstacle = memory_obstacle(options, size, execution_.machine().memory_bytes);
  if (!obstacle.empty()) {
    throw Error(obstacle);
  }
  job.plan = entry.plan(options, size);
  const auto search = entry.start(job, pools_);
  if (is_resumed) {
    search->resume(*request.deferred);
  } else {
    search->start();
  }
  set_needs(entry.abilities, job);
  if (request.previous != nullptr && !choose_tiles(*search, job)) {
    return;
  }
  search->prepare();
  for (MapTask& task : job.tasks) {
    if (task.need.whole) {
      clock.start(task.name);
    }
    search->search(task);
  }
  const auto work = pools_.refinement.borrow();
  search->refine(*work);
  erase_left_out(call, maps, times);
  examine(call, job);
}

void MatchRunner::erase_left_out(const MatchCall& call, DisparityMaps& maps,
                                 MatchReport& report) const {
  std::vector<std::string> shares;
  for (std::size_t i = 0; i < (call.baselines.empty() ? 2U : 1U); ++i) {
    const Mask& left_out = call.images[i].photograph->left_out;
    const Side side = i == 0 ? call.reference_side : other_side(call.reference_side);
    vantage::erase_left_out(left_out, maps.of(side));
    if (!left_out.empty()) {
      const double percent = std::max(0.1, 100 * share_of(left_out));
      shares.push_back(fmt::format("{:.{}f} % of the {} image", percent, percent < 1 ? 1 : 0,
                                   side == Side::kLeft ? "left" : "right"));
    }
  }
  if (!shares.empty()) {
    report.note("region",
                fmt::format("region: {} is not scene; left out", fmt::join(shares, ", ")));
  }
}

/// What the finished maps are worth, and the confidence of their pixels.
void MatchRunner::examine(const MatchCall& call, SearchJob& job) const {
  job.clock.start("examine");
  const bool is_pair = call.baselines.empty();
  const bool is_along_rows = call.grids == nullptr && !options_.disparities_y;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    if (!job.request.wants(side) || (!is_pair && side != call.reference_side)) {
      continue;
    }
    const std::size_t image = is_pair ? index_of(side) : 0;
    const FinishedMap finished{.map = &job.maps.of(side),
                               .has_mask = options_.refinement || job.request.unmatched,
                               .is_checked = job.is_checked(),
                               .side = side,
                               .image = job.images[image].photograph,
                               .other = is_along_rows ? job.images[1 - image].photograph : nullptr};
    if (!job.report.shares) {
      job.report.shares = map_shares(finished, execution_);
      warn_of_doubtful_map(*job.report.shares, job.report.remarks);
    }
    if (job.request.probability) {
      map_confidence(finished, execution_, job.maps.of(side).confidence);
    }
  }
}

/// Chooses the tiles of both maps that are searched. False: the images moved, and the call is left
/// for later.
bool MatchRunner::choose_tiles(MapSearch& search, SearchJob& job) const {
  job.clock.start("changes");
  const MatchRequest& request = job.request;
  std::uint32_t needed = job.wants_confidence() ? 1 : 0;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const MapTask& task = job.task_of(side);
    for (const bool is_needed :
         {task.is_result, task.need.whole, task.need.check, task.need.check_is_only}) {
      needed = 2 * needed + (is_needed ? 1 : 0);
    }
  }
  const auto halves = search.half_size_images();
  const Photograph& of_map = *job.tasks.front().image;
  if (request.previous->choose(*halves[0], *halves[1],
                               {{of_map.width(), of_map.height()}, needed})) {
    job.previous = request.previous;
  } else {
    job.report.searched_share = 1;
    if (request.deferred != nullptr) {
      search.defer(*request.deferred);
      return false;
    }
  }
  job.clock.start("prepare");
  return true;
}

std::vector<scheduler::ChainPlan> MatchRunner::plans(const MatchCall& call,
                                                     std::span<const ExecutionOptions> executions) {
  const MatchRequest request;
  DisparityMaps maps;  // never read
  MatchReport report;  // never read
  StageClock clock(report);
  SearchJob job = job_of(options_, call, request, maps, report, clock);
  ResolvedMatchOptions at_full_size = options_;
  at_full_size.parameters.search_size = SearchSize::kFull;
  const MatchSize size = size_of(call, false);
  const SearchEntry& entry = search_of(at_full_size, size);
  require_abilities(entry.abilities, options_);
  job.plan = entry.plan(at_full_size, size);
  const auto search = entry.start(job, pools_);
  search->start();
  job.task_of(call.reference_side).need = {.whole = true};
  search->prepare();
  return search->plans(job.task_of(call.reference_side), executions);
}

void MatchRunner::add_memory_use(MemoryUse& use) const {
  pools_.add_memory_use(use);
  smoothed_.for_each_idle([&use](const std::vector<SmoothedPhotograph>& images) {
    for (const SmoothedPhotograph& image : images) {
      use.add("smoothed images", image.held_bytes());
    }
  });
}

}  // namespace vantage
