#pragma once

#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/rectification/rectifier.h"
#include "engine/synthesis/whole_photograph.h"

namespace vantage {

/// How the pixels of a rectified image and of the photograph that it was made from lie to each
/// other. `positions` have the size of the rectified image's map, `disparity_px` that of the
/// photograph. Nothing is owned.
struct PhotographGeometry {
  PhotographPositions positions;        ///< of the rectified image's pixels
  ImageView<const float> disparity_px;  ///< of the photograph's pixels, in the rectified image
  /// What lies outside the rectified image, for views from its camera's place; may be null.
  const WholePhotograph* whole = nullptr;

  /// Of images that are rectified from the beginning.
  [[nodiscard]] bool empty() const { return disparity_px.empty(); }
};

/// The photographs of a rectified pair as they were read: what its new views take their colours
/// from in one interpolation, where the rectified images have been interpolated before. Nothing is
/// owned.
struct UnrectifiedPair {
  const Photograph& left;
  const Photograph& right;
  PhotographGeometry left_geometry;
  PhotographGeometry right_geometry;
};

}  // namespace vantage
