#pragma once

#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/matching/options/match_options.h"

namespace vantage {

/// What plans are timed on.
struct TuningPair {
  Photograph left;
  Photograph right;
};

/// A made-up pair of textured surfaces at depths that fill most of `disparities`; 8 bits, grey or
/// colour. Pixels from 192 rows on repeat those above, mirrored. Sides 1..16384.
TuningPair make_tuning_pair(int width_px, int height_px, DisparityRange disparities, bool grey,
                            Execution& execution);

/// The uppermost `rows` (1..height) rows of both images.
TuningPair top_rows(const TuningPair& pair, int rows);

}  // namespace vantage
