#pragma once

#include "engine/rectification/camera.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage {

/// A lens and the size of its images.
struct SizedCamera {
  Camera camera;
  ImageSize size;  ///< 0×0 if the file does not tell
};

}  // namespace vantage
