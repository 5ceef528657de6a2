#pragma once

#include "engine/image/side.h"
#include "engine/image/volume_sink.h"

namespace vantage {

/// Which cells of the disparity space.
enum class VolumeKind {
  kCosts,       ///< E0 (6.1) as the method starts from it; for Bayes −ln p0
  kAggregated,  ///< what winners are selected from: energies, or for Bayes probabilities
};

/// A volume to compute along with a map.
struct VolumeRequest {
  Side side = Side::kLeft;  ///< of a map that is requested, too
  VolumeKind kind = VolumeKind::kAggregated;
  int level = 0;               ///< 0: the image's own
  VolumeSink* sink = nullptr;  ///< not owned
};

}  // namespace vantage
