#pragma once

#include <optional>

#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/rectification/rectifier.h"

namespace vantage {

class WholePhotograph;

/// Correspondence between the pixels of a rectified image and its photograph. `positions` have the
/// size of the rectified image's map, `disparity_px` that of the photograph. Nothing is owned.
struct PhotographGeometry {
  PhotographPositions positions;        ///< of the rectified image's pixels
  ImageView<const float> disparity_px;  ///< of the photograph's pixels, in pixels of the rectified
                                        ///< image
  /// The area outside the rectified image, for views from its camera's position; may be null.
  const WholePhotograph* whole = nullptr;

  /// True for images that were rectified to begin with.
  [[nodiscard]] bool empty() const { return disparity_px.empty(); }
};

/// The original photographs of a rectified pair: new views fetch colours from them in one
/// interpolation, where rectified images add another. Nothing is owned.
struct UnrectifiedPair {
  const Photograph& left;
  const Photograph& right;
  PhotographGeometry left_geometry;
  PhotographGeometry right_geometry;
};

/// Inputs for the views of one frame. Nothing is owned.
struct ViewSource {
  const Photograph& left;  ///< rectified, as is `right`
  const Photograph& right;
  ImageView<const float> left_disparity_px;
  ImageView<const float> right_disparity_px;
  /// The photographs that `left` and `right` were rectified from, for colours in one interpolation;
  /// empty if there are none, or if colours move by whole pixels.
  std::optional<UnrectifiedPair> photographs = std::nullopt;
};

}  // namespace vantage
