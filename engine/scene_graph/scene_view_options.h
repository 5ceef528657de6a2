#pragma once

#include "engine/error.h"
#include "engine/synthesis/synthesis_options.h"

namespace vantage {

/// `options` for views of a scene: brightness moves from image to image. Throws UsageError if they
/// warp forward. Thread rule: pure.
inline SynthesisOptions with_moving_brightness(SynthesisOptions options) {
  if (options.warp == WarpColour::kForward) {
    throw UsageError("warp is forward, expected one-pass for views of a scene");
  }
  options.gamma.reset();
  return options;
}

}  // namespace vantage
