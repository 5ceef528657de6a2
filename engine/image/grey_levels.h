#pragma once

#include "engine/image/photograph.h"

namespace vantage {

/// Writes the grey levels 0..255 of row y, not rounded: the luma (Rec. 601) of colours, alpha left
/// out (EQUATIONS §0). `grey` has room for the photograph's width. Thread rule: may be called
/// concurrently.
void grey_levels_row(const Photograph& photograph, int y, float* grey);

/// The same of one colour channel, 0..2, of a photograph of at least 3.
void channel_levels_row(const Photograph& photograph, int channel, int y, float* levels);

}  // namespace vantage
