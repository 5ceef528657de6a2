#pragma once

#include "engine/image/photograph.h"

namespace vantage {

/// Writes the unrounded grey levels 0..255 of row y: the luma (Rec. 601) of colours; alpha is
/// ignored (EQUATIONS §0). `grey` must have room for a row. Thread rule: may be called
/// concurrently.
void intensity_row(const Photograph& photograph, int y, float* grey);

/// As intensity_row(), for one colour channel, 0..2, of a photograph of at least 3 channels.
void channel_intensity_row(const Photograph& photograph, int channel, int y, float* intensities);

}  // namespace vantage
