#pragma once

#include "engine/image/photograph.h"

namespace vantage {

/// Writes the grey levels 0..255 of row y, not rounded: the luma (Rec. 601) of colours, alpha left
/// out (EQUATIONS §0). `grey` has room for the photograph's width. Thread rule: may be called
/// concurrently.
void grey_levels_row(const Photograph& photograph, int y, float* grey);

}  // namespace vantage
