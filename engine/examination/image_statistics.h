#pragma once

#include "engine/image/photograph.h"

namespace vantage {

/// Exposure and texture of a photograph; shares of its pixels.
struct ImageStatistics {
  double mean_grey = 0;    ///< grey levels, 0..255
  double black_share = 0;  ///< at most 1 grey level
  double white_share = 0;  ///< at least 254 grey levels
  /// Without texture, as Scharstein and Szeliski (2002) have it: the squared horizontal gradient,
  /// averaged over 3×3 pixels, is below 4 squared grey levels and what noise adds to it.
  double textureless_share = 0;
};

/// `noise_grey`: standard deviation of the noise in grey levels, 0: none. Thread rule: may be
/// called concurrently.
ImageStatistics image_statistics(const Photograph& photograph, double noise_grey);

}  // namespace vantage
