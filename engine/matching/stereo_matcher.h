#pragma once

#include <string_view>
#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/matching/intensity_planes.h"
#include "engine/matching/match_options.h"
#include "engine/object_pool.h"
#include "engine/refinement/speckles.h"
#include "scheduler/strip_plan.h"

namespace vantage {

/// Results of one pair, on the grid of the images. Reused from call to call without allocating.
/// Each member is filled only when MatchRequest asked for it (or the work needed it anyway).
struct DisparityMaps {
  DisparityMap left;    ///< on the left grid
  DisparityMap right;   ///< on the right grid
  Mask left_unmatched;  ///< 255 where cross-check or border left the pixel without a match
  Mask right_unmatched;
};

/// What the caller wants. With refinement (options.raw == false) all of it is computed anyway.
struct MatchRequest {
  bool left = true;
  bool right = true;
  bool unmatched = true;  ///< the masks of the maps
};

/// Seconds spent per part, in the order they ran.
struct StageTime {
  std::string_view name;  ///< static storage
  double seconds = 0;
};

struct MatchReport {
  std::vector<StageTime> stages;
  scheduler::ChainPlan plan;  ///< of one map; both maps use the same
  double cells = 0;           ///< width × height × disparities × maps computed
};

/// Computes disparity maps of rectified pairs (EQUATIONS §1, §3, §5).
///
/// Thread rule: match() may be called concurrently for different results. Results are identical for
/// any ExecutionOptions and on any instruction set.
class StereoMatcher {
 public:
  /// Throws UsageError for invalid options. `execution` must outlive the matcher.
  StereoMatcher(const MatchOptions& options, Execution& execution);

  /// left and right: equal size, at least 1×1, any depth and channels; depths may differ.
  /// Throws Error when sizes differ or no pixel has a candidate in the range.
  void match(const Photograph& left, const Photograph& right, const MatchRequest& request,
             DisparityMaps& maps, MatchReport* report = nullptr) const;

  [[nodiscard]] const MatchOptions& options() const { return options_; }

 private:
  void compute_map(Reference reference, const PreparedPair& pair, DisparityMap& map_px,
                   MatchReport& report) const;

  MatchOptions options_;
  Execution& execution_;
  mutable ObjectPool<PreparedPair> prepared_pairs_;
  mutable ObjectPool<SpeckleWork> speckle_works_;
};

}  // namespace vantage
