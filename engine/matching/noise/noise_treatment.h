#pragma once

#include <optional>
#include <span>
#include <string>

#include "engine/execution.h"
#include "engine/matching/noise/noise_estimate.h"
#include "engine/matching/noise/noise_filter.h"

namespace vantage {

/// What is done about noise before images are compared: how strongly they are smoothed.
struct NoiseTreatment {
  FoundNoise found;
  NoiseFilter filter;

  [[nodiscard]] bool acts() const { return filter.smooths(); }
  /// "noise: 5.1 grey levels; costs compare images smoothed by 2.0 px"
  [[nodiscard]] std::string text() const;
};

/// By ResolvedMatchOptions::noise; disparities: as of find_noise(). A function of the images of
/// this call alone.
NoiseTreatment noise_treatment(std::span<const Photograph* const> photographs,
                               const std::optional<double>& noise_grey_levels,
                               const std::optional<DisparityRange>& disparities,
                               Execution& execution);

}  // namespace vantage
