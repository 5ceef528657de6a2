#pragma once

#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/matching/options/match_options.h"

namespace vantage {

/// The images on which plans are timed.
struct TuningPair {
  Photograph left;
  Photograph right;
};

/// A synthetic pair of textured surfaces at depths that fill most of `disparities`; 8 bits, grey or
/// colour. Rows from 192 on mirror those above. Sides 1..16384.
TuningPair make_tuning_pair(int width_px, int height_px, DisparityRange disparities, bool grey,
                            Execution& execution);

/// The top `rows` (1..height) rows of both images.
TuningPair top_rows(const TuningPair& pair, int rows);

}  // namespace vantage
