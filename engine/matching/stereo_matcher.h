#pragma once

#include <memory>
#include <span>
#include <vector>

#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/image/memory_use.h"
#include "engine/image/photograph.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/search/match_inputs.h"
#include "engine/matching/search/match_report.h"
#include "engine/matching/search/match_request.h"
#include "scheduler/strip_plan.h"

namespace vantage {

class MatchRunner;
struct MatchCall;

/// Computes disparity maps of rectified pairs (EQUATIONS §1, §3, §5).
///
/// Thread rule: match() may be called concurrently for different results. Results are identical for
/// any ExecutionOptions and any instruction set, except for Bayesian diffusion with
/// PriorSmoothing::kSum: its probabilities agree to 1e-5 between instruction sets and processor
/// makers (with several levels: unless values stored between levels round differently).
class StereoMatcher {
 public:
  /// Throws UsageError for invalid options. `execution` must outlive the matcher.
  explicit StereoMatcher(const MatchOptions& options, Execution& execution = default_execution());
  StereoMatcher(const StereoMatcher&) = delete;
  StereoMatcher& operator=(const StereoMatcher&) = delete;
  ~StereoMatcher();

  /// left and right: equal size, at least 1×1, any depth and channels; depths may differ. Throws
  /// Error when sizes differ, no pixel has a candidate in the range or the machine has too little
  /// memory, UsageError for a prior's
  /// weight out of range, a prior with a vertical search, or a volume that cannot be had: of a
  /// level that the images do not have, with a reduced search-size, or of a part of the images
  /// (roi, scale).
  void match(const Photograph& left, const Photograph& right, const MatchRequest& request,
             DisparityMaps& maps, MatchReport* report = nullptr) const;

  /// Execution plan for the left map (its finest level, if there are several), as match() reports
  /// it if both maps are computed. Errors as match().
  [[nodiscard]] scheduler::ChainPlan plan(const Photograph& left, const Photograph& right) const;
  /// One plan for each of `executions` instead of the matcher's own, on the same machine.
  [[nodiscard]] std::vector<scheduler::ChainPlan> plans(
      const Photograph& left, const Photograph& right,
      std::span<const ExecutionOptions> executions) const;
  /// The plan that match_several() uses for these images. Throws as match_several() does.
  [[nodiscard]] scheduler::ChainPlan plan_several(const Photograph& reference,
                                                  std::span<const OtherView> others) const;

  /// Matches `reference` against all of `others` at once (6.6): the partner of column x in the k-th
  /// of them is x − d · baseline_k / |baseline_1|, so candidates are disparities between the
  /// reference and the first. A candidate counts if any of them sees it. A cross-check compares
  /// with the map of the nearest image of either side. The result is maps.left if the first is to
  /// the right of the reference, maps.right if it is to the left. At least one other; all images of
  /// equal size; baselines distinct and not 0. Errors as match(), and UsageError for selection
  /// symmetric, which is of two images.
  void match_several(const Photograph& reference, std::span<const OtherView> others,
                     const MatchRequest& request, DisparityMaps& maps,
                     MatchReport* report = nullptr) const;

  /// Working memory kept between calls and not in use at the moment: "prepared images", "coarse
  /// levels" and "refinement". Strips use the scratch memory of the execution.
  void add_memory_use(MemoryUse& use) const;

  [[nodiscard]] const ResolvedMatchOptions& in_force() const { return in_force_; }

 private:
  void run(const MatchCall& call, const MatchRequest& request, DisparityMaps& maps,
           MatchReport* report) const;
  [[nodiscard]] std::vector<scheduler::ChainPlan> plans(
      const MatchCall& call, std::span<const ExecutionOptions> executions) const;

  const ResolvedMatchOptions in_force_;
  const ResolvedMatchOptions of_part_;  ///< those of the runner
  Execution& execution_;
  std::unique_ptr<MatchRunner> runner_;
};

}  // namespace vantage
