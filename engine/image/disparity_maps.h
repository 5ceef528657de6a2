#pragma once

#include <cstddef>

#include "engine/image/image.h"
#include "engine/image/memory_use.h"
#include "engine/image/side.h"

namespace vantage {

/// Matching results for the pixels of one image, on its grid. Images that were not requested are
/// empty or undefined.
struct MatchedMap {
  DisparityMap disparity_px = {};
  DisparityMap disparity_y_px = {};  ///< y_left − y_right of a two-dimensional search, else empty
  /// With MatchRequest::probability: that of each disparity to be within 1 px of the true one. With
  /// `confidence`: of the winners, before refinement: M = max Ê for evidence (5.12), max p for
  /// Bayes, the certainty in use for local stopping, the winner margin (6.13) otherwise.
  Image<float> confidence = {};
  Mask unmatched = {};  ///< 255 where refinement or the border left the pixel without a match
};

/// Maps of a pair. Can be reused without reallocation.
struct DisparityMaps {
  MatchedMap left;
  MatchedMap right;

  [[nodiscard]] MatchedMap& of(Side side) { return side == Side::kLeft ? left : right; }
  [[nodiscard]] const MatchedMap& of(Side side) const { return side == Side::kLeft ? left : right; }
};

/// Total bytes held by the non-empty images.
inline std::size_t held_bytes(const MatchedMap& map) {
  return held_bytes(map.disparity_px) + held_bytes(map.disparity_y_px) +
         held_bytes(map.confidence) + held_bytes(map.unmatched);
}
inline std::size_t held_bytes(const DisparityMaps& maps) {
  return held_bytes(maps.left) + held_bytes(maps.right);
}

}  // namespace vantage
