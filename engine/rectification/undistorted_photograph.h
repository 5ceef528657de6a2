#pragma once

#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/rectification/camera.h"

namespace vantage {

/// The photograph of the pinhole camera with the same K and size: `source` itself without
/// distortion, black where the photograph shows nothing. Identical for any `execution`.
Photograph undistorted(Photograph source, const Camera& lens, Execution& execution);

}  // namespace vantage
