#include "engine/matching/noise/noise_treatment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

/// Chosen on cones, art, baby1 and venus, seen on six others (perf/log, noise).
constexpr double kCutOffPerNoise = 3.5;
constexpr double kSigmaPx = 2;
constexpr NoiseFilter kFilterOfCoded = {.sigma_px = 1, .cut_off_grey_levels = 20};

NoiseFilter filter_of(const FoundNoise& found) {
  switch (found.kind) {
    case NoiseKind::kNone:
      return {};
    case NoiseKind::kCodec:
      return kFilterOfCoded;
    case NoiseKind::kSensor:
      return {.sigma_px = kSigmaPx, .cut_off_grey_levels = kCutOffPerNoise * found.grey_levels};
  }
  return {};
}

}  // namespace

std::string NoiseTreatment::text() const {
  return found.kind == NoiseKind::kCodec
             ? fmt::format(
                   "noise: blocks of a lossy codec; images are compared smoothed by {:.1f} px",
                   filter.sigma_px)
             : fmt::format("noise: {:.1f} grey levels; images are compared smoothed by {:.1f} px",
                           found.grey_levels, filter.sigma_px);
}

NoiseTreatment noise_treatment(std::span<const Photograph* const> photographs,
                               const std::optional<double>& noise_grey_levels,
                               const std::optional<DisparityRange>& disparities,
                               Execution& execution) {
  NoiseTreatment treatment;
  if (!noise_grey_levels) {
    treatment.found = find_noise(photographs, disparities, execution);
  } else if (*noise_grey_levels > 0) {
    treatment.found = {.kind = NoiseKind::kSensor, .grey_levels = *noise_grey_levels};
  }
  treatment.filter = filter_of(treatment.found);
  return treatment;
}

}  // namespace vantage
