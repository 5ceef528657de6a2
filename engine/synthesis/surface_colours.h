#pragma once

#include <cstdint>

#include "engine/image/image.h"
#include "engine/synthesis/unrectified_pair.h"
#include "kernels/source_position/source_position.h"

namespace vantage {

/// Source of a new view's colours: an image, or the photograph that it was made from. Thread rule:
/// may be used concurrently. Nothing is owned. T is uint8_t, uint16_t or float.
template <typename T>
struct SurfaceColours {
  ImageView<const T> pixels;            ///< of the photograph, if there is one
  ImageView<const float> disparity_px;  ///< of the image
  PhotographGeometry photograph = {};   ///< empty: the pixels are the image's
  float gradient_limit_px = 1;

  /// One bicubic interpolation at each of `count` positions in the image (fetch_surface_row()),
  /// pixel_lanes(channels) values each. With a photograph, `positions` are converted to positions
  /// in it; positions outside it give 0.
  void fetch(const kernels::SourcePositions& positions, int count, float* colours) const;
};

}  // namespace vantage
