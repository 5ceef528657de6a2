#pragma once

#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/image/photograph.h"
#include "engine/image/side.h"

namespace vantage {

/// A finished map and the images it was matched from.
struct FinishedMap {
  const MatchedMap* map = nullptr;
  bool has_mask = true;  ///< of unmatched pixels
  /// The mask says which pixels the other map contradicts; else it is no evidence.
  bool is_checked = true;
  Side side = Side::kLeft;
  const Photograph* image = nullptr;  ///< of the map
  /// Shows pixel x of the map at x − disparity in the left map, x + disparity in the right one.
  /// Null: it does not, as in a vertical search; then less is known.
  const Photograph* other = nullptr;
};

/// The probability, 0..1, that each disparity is within 1 px of the true one; 0 where it is unknown
/// (EQUATIONS §5.11). Estimated from the images and the map alone, so it means the same for all
/// methods. Resizes `confidence`, which may be the map's own. Identical for any `execution`.
void map_confidence(const FinishedMap& finished, Execution& execution, Image<float>& confidence);

/// The mean of a sample of about 2000 pixels, without those that are left out of the image.
double mean_confidence(const FinishedMap& finished, Execution& execution);

}  // namespace vantage
