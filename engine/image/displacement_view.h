#pragma once

#include "engine/image/image.h"

namespace vantage {

/// Both components of the displacements of a two-dimensional search, on one image's grid.
struct DisplacementView {
  ImageView<const float> x_px;  ///< d = x_left − x_right
  ImageView<const float> y_px;  ///< y_left − y_right
};

}  // namespace vantage
