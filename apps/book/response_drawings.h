#pragma once

#include <optional>
#include <span>

#include "engine/evaluation/cumulative_response.h"
#include "engine/plot/drawing.h"

namespace vantage::apps {

struct SmallestRms {
  Displacement displacement;
  double rms = 0;
};
/// The displacement with the smallest RMS difference among those for which at least half of the
/// pixels have a partner, ties going to the first. None without differences. `rms`: of the
/// displacements of `response`, or empty.
std::optional<SmallestRms> smallest_rms(const CumulativeResponse& response,
                                        std::span<const double> rms);

/// Sums per pixel (Fig. 5.5), and negated RMS differences beside them (Fig. 5.6) unless `rms` is
/// empty: curves over one range, heat maps over two.
Drawing draw_response(const CumulativeResponse& response, std::span<const double> rms);

/// The evidence for the dominant displacement of the image and of each quadrant (Fig. 5.4): grey
/// is 0, light for, dark against a match.
Drawing draw_evidence(const CumulativeResponse& response, const Photograph& left,
                      const Photograph& right, const MethodParameters& parameters,
                      Execution& execution);

}  // namespace vantage::apps
