#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "engine/execution.h"
#include "engine/image/memory_use.h"
#include "engine/matching/noise/noise_filter.h"
#include "engine/matching/search_table.h"

namespace vantage {

/// A call of a matcher, checked for what its images are.
struct MatchCall {
  std::vector<SearchedPhotograph> images;  ///< as SearchJob::images
  std::vector<double> baselines = {};      ///< of several images
  Side reference_side = Side::kLeft;       ///< as SearchJob::reference_side
  const EpipolarGrids* grids = nullptr;    ///< of a pair that is not rectified
};

/// What all searches have in common, around the one that serves a call: what it refuses, the demand
/// for memory, tiles kept from the pair before, deferral, which maps are computed for
/// the cross-check, and the report. Thread rule: run() may be called concurrently for different
/// results.
class MatchRunner {
 public:
  /// Both outlive the runner.
  MatchRunner(const ResolvedMatchOptions& options, Execution& execution);

  /// Errors and results as StereoMatcher::match(). report: null: not requested.
  void run(const MatchCall& call, const MatchRequest& request, DisparityMaps& maps,
           MatchReport* report);
  /// Plans for the map of the first image at full size, one for each of `executions`.
  [[nodiscard]] std::vector<scheduler::ChainPlan> plans(
      const MatchCall& call, std::span<const ExecutionOptions> executions);
  void add_memory_use(MemoryUse& use) const;

 private:
  /// As given, or found in the images.
  [[nodiscard]] FoundNoise noise_of(const MatchCall& call);
  /// Replaces the images of the call by what costs see of them.
  void smooth(const NoiseFilter& filter, std::vector<SmoothedPhotograph>& smoothed,
              MatchCall& call);
  [[nodiscard]] MatchSize size_of(const MatchCall& call, bool keeps_costs) const;
  [[nodiscard]] SearchJob job_of(const ResolvedMatchOptions& options, const MatchCall& call,
                                 const MatchRequest& request, DisparityMaps& maps,
                                 MatchReport& report, StageClock& clock) const;
  /// Makes unknown, and tells, what is left out of the images.
  void erase_left_out(const MatchCall& call, DisparityMaps& maps, MatchReport& report) const;
  void examine(const MatchCall& call, SearchJob& job) const;
  [[nodiscard]] bool choose_tiles(MapSearch& search, SearchJob& job) const;

  const ResolvedMatchOptions& options_;
  std::array<ResolvedMatchOptions, kNoiseKinds> options_of_;  ///< by NoiseKind
  Execution& execution_;
  ObjectPool<std::vector<SmoothedPhotograph>> smoothed_;
  SearchPools pools_;
};

}  // namespace vantage
