#pragma once

#include <memory>

#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/image/photograph.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/search/match_report.h"
#include "engine/rectification/epipolar_grid.h"
#include "engine/rectification/rectifier.h"

namespace vantage {

class MatchRunner;

/// What is made of a pair that is not rectified.
struct UnrectifiedRequest {
  bool left = true;
  bool right = true;
  bool probability = false;  ///< see MatchRequest
};

/// Matches photographs of a calibrated pair as they are, with rectification folded into the search
/// (5.3.2, EQUATIONS §3.20): maps are on the pixels of the photographs, disparities those of the
/// rectified pair. The photograph of a map is not resampled, the other one once.
///
/// Thread rule: match() may be called concurrently for different results. Results are identical for
/// any execution.
class UnrectifiedMatcher {
 public:
  /// Throws UsageError for invalid options, and for those that need rows: a search in two
  /// dimensions, selection symmetric, a cross-check of coarse levels. `rectifier` and `execution`
  /// must outlive it. Takes 16 bytes per pixel and image.
  UnrectifiedMatcher(const MatchOptions& options, const Rectifier& rectifier, Execution& execution);
  UnrectifiedMatcher(const UnrectifiedMatcher&) = delete;
  UnrectifiedMatcher& operator=(const UnrectifiedMatcher&) = delete;
  ~UnrectifiedMatcher();
  /// Throws UsageError as the constructor does, but for a range that is to be found.
  static void validate(MatchOptions options);

  /// The same with the grids of a rectifier that others use, too.
  UnrectifiedMatcher(const MatchOptions& options, std::shared_ptr<const EpipolarGrids> grids,
                     Execution& execution);

  /// Photographs of the rectifier's size. Always makes the masks. Errors as StereoMatcher::match().
  void match(const Photograph& left, const Photograph& right, const UnrectifiedRequest& request,
             DisparityMaps& maps, MatchReport* report = nullptr) const;

  [[nodiscard]] const ResolvedMatchOptions& in_force() const { return in_force_; }

 private:
  ResolvedMatchOptions in_force_;
  std::shared_ptr<const EpipolarGrids> grids_;
  std::unique_ptr<MatchRunner> runner_;
};

}  // namespace vantage
