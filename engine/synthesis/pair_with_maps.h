#pragma once

#include <optional>

#include "engine/image/disparity_maps.h"
#include "engine/image/photograph.h"
#include "engine/rectification/rectified_pair.h"
#include "engine/rectification/rectifier.h"

namespace vantage {

/// The images as they were read, and how they became rectified ones.
struct UnrectifiedImages {
  Rectifier rectifier;
  Photograph left;
  Photograph right;
};

/// A rectified pair and its maps.
struct PairWithMaps {
  std::optional<UnrectifiedImages> unrectified;  ///< where they had to be rectified
  std::optional<RectifiedPair> cameras;          ///< with a calibration
  Photograph left;
  Photograph right;
  DisparityMaps maps;
};

}  // namespace vantage
