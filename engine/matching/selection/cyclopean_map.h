#pragma once

#include <cstdint>

#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/image/image.h"

namespace vantage {

/// What the two cameras see of a pixel of the cyclopean map: values of its mask.
enum class SeenBy : std::uint8_t {
  kBoth = 0,
  kNone = 64,   ///< no match, although nothing hides it from one camera
  kLeft = 128,  ///< hidden from the right camera, or outside its image
  kRight = 255
};

/// The disparity map of a camera in the middle of both (6.1, 6.7, 7.3).
struct CyclopeanMap {
  DisparityMap disparity_px;  ///< of the pair, from left to right; NaN unless both cameras see it
  Mask seen_by;               ///< values of SeenBy
};

/// Makes it from the matches of the left image, those that are not marked in `left.unmatched`:
/// column x with disparity d lies at x − d/2. Matches at most two columns apart whose
/// disparities differ by at most 1.5 px are one surface, and pixels between them get disparities
/// between theirs; where surfaces overlap, the nearer one counts. `left` has a mask. Meant for
/// symmetric selection, whose matches are those of both images. Identical for any `execution`.
void make_cyclopean_map(const MatchedMap& left, Execution& execution, CyclopeanMap& map);

}  // namespace vantage
