#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/memory_use.h"
#include "engine/image/side.h"

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

/// A row of the other map: runs that are not matched take the smaller disparity of both their ends,
/// because what is not matched is mostly background. NaN in a row without matches.
void copy_seen_row(const OtherCameraView& other, int y, float* seen_px);

}  // namespace vantage
