#pragma once

#include <optional>

#include "engine/image/side.h"
#include "engine/matching/costs/displacement_grid.h"
#include "engine/matching/options/match_options.h"
#include "kernels/candidates.h"

namespace vantage {

/// The candidates of `options` that some pixel of an image `width` columns wide can have.
/// `reference` is the image whose grid the map is on. Throws Error when there is none.
kernels::CandidateGeometry candidate_geometry(const ResolvedMatchOptions& options, Side reference,
                                              int width, int height);

/// The grid that `options` ask for on images of this size; empty: a search along rows only. Leaves
/// out what no pixel can have. Throws Error when no pixel has a candidate.
std::optional<DisplacementGrid> displacement_grid(const ResolvedMatchOptions& options,
                                                  Side reference, int width, int height);

}  // namespace vantage
