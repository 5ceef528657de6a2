#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/execution.h"
#include "engine/image/disparity_range.h"
#include "engine/image/photograph.h"
#include "engine/matching/noise/noise_kind.h"
#include "engine/matching/noise/shared_texture.h"

namespace vantage {

/// What a photograph's grey levels (0..255) say about noise and compression.
struct NoiseEstimate {
  /// Standard deviation of the noise, or fine texture, that even the smoothest parts have.
  double floor_grey_levels = 0;
  /// By how many standard errors differences at the borders of blocks exceed those beside them:
  /// below 3.5 without blocks in both images, above 5 with them.
  double block_score = 0;
  /// The smoothest parts.
  std::vector<BlockPlace> smoothest = {};
};

/// Measured in at most about 1,200 blocks of 8x8 pixels that are spread over the image. Of images
/// of fewer than 64 pixels a side: nothing. Identical for any `execution`.
NoiseEstimate estimate_noise(const Photograph& photograph, Execution& execution);

/// What the images of a call have in common: noise where all have it.
struct FoundNoise {
  NoiseKind kind = NoiseKind::kNone;
  double grey_levels = 0;  ///< kSensor: standard deviation, the mean of the images
  double block_score = 0;  ///< kCodec: the smallest of the images
};
/// Files that state how coarsely a codec rounded are believed, others are examined.
/// disparities: of the second image, where rows correspond: what is found again there is texture,
/// not noise. Empty: not known.
FoundNoise find_noise(std::span<const Photograph* const> photographs,
                      const std::optional<DisparityRange>& disparities, Execution& execution);

}  // namespace vantage
