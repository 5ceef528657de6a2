#pragma once

#include "kernels/surface_splat/surface_splat.h"

namespace vantage::kernels {

/// What splat_rows() adds between the pixels of one quad: upper columns i and i + 1 and those below
/// them. Few quads have gaps, so this is plain code for all instruction sets.
void fill_quad_gaps(const SplatRows& rows, int i, const SplatBand& band);

}  // namespace vantage::kernels
