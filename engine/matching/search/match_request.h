#pragma once

#include <span>

#include "engine/matching/search/deferred_match.h"
#include "engine/matching/search/match_inputs.h"
#include "engine/matching/volume/volume_request.h"

namespace vantage {

class PreviousMaps;

/// Requested outputs. A map that is not requested may still be computed for the cross-check of the
/// other one; its contents are undefined. Without `previous`, maps do not depend on whether the
/// other is requested.
struct MatchRequest {
  bool left = true;
  bool right = true;
  bool unmatched = true;    ///< the masks of the maps
  bool confidence = false;  ///< the confidence of the winners, before refinement
  /// In its place the probability of each disparity of the finished maps, see map_confidence().
  bool probability = false;
  /// Volumes written to their sinks while maps are computed, not for a reduced search-size. Maps do
  /// not depend on them.
  std::span<const VolumeRequest> volumes = {};
  DisparityPrior prior = {};  ///< without a vertical search only
  /// For match() without reuse_obstacle(), prior and volumes: tiles keep the maps of the pair
  /// before. Replaced by the maps of this pair; a request with it runs alone.
  PreviousMaps* previous = nullptr;
  /// With `previous`: where the images moved, match() makes no maps, but sets this. The same call
  /// with this and without `previous` makes them: in any thread, also while pairs after it are
  /// matched.
  DeferredMatch* deferred = nullptr;

  [[nodiscard]] bool wants(Side side) const { return side == Side::kLeft ? left : right; }
  [[nodiscard]] bool uses_prior() const { return !prior.empty() && prior.weight > 0; }
};

}  // namespace vantage
