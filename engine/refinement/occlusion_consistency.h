#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/memory_use.h"
#include "engine/image/side.h"
#include "engine/refinement/filled_medians.h"

namespace vantage {

/// What the other camera sees of a map's pixels.
struct OtherCameraView {
  ImageView<const float> map_px;  ///< of the other image
  Image<std::uint64_t> matched;   ///< bits of its pixels that the cross-check confirms (row_bits.h)
  DisparityMap copy_px;           ///< of its map, where that will change
  Side side = Side::kLeft;        ///< of the map, not of the other camera
  float columns_per_px = 1;       ///< as in cross_check()
};

inline std::size_t held_bytes(const OtherCameraView& view) {
  return held_bytes(view.matched) + held_bytes(view.copy_px);
}

/// Keeps which pixels of other.map_px agree with this map, before either is changed. unmatched:
/// working memory.
void keep_matched(ImageView<const float> map_px, double tolerance_px, Execution& execution,
                  Mask& unmatched, OtherCameraView& other);

/// Mends filled pixels (≠ 0 in `unmatched`) which would hide from the other camera what it sees:
/// the other map is known and farther by more than 1 px at their partner and beside it (EQUATIONS
/// §5.7). They take a weighted median of disparities around them that would not, if there is any.
/// medians: as take_filled_medians() of the same map left it. contradicted: working memory.
/// Identical for any `execution`.
void mend_contradicted(const Mask& unmatched, const OtherCameraView& other,
                       const FilledMediansWork& medians, Execution& execution, Mask& contradicted,
                       DisparityMap& map_px);

}  // namespace vantage
