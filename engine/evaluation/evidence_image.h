#pragma once

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/matching/estimation/evidence_pair.h"

namespace vantage {

/// E_δ (5.5) at every pixel of the left image, in grey levels per pixel; NaN where the partner is
/// outside the right image. Uses alpha, norm, gradient and prefilter of `parameters`. Throws
/// UsageError for invalid parameters, Error when sizes differ. Identical for any `execution`.
Image<float> evidence_image(const Photograph& left, const Photograph& right,
                            Displacement displacement, const MethodParameters& parameters,
                            Execution& execution);

}  // namespace vantage
