#pragma once

#include <cstdint>
#include <memory>

#include "engine/matching/costs/intensity_planes.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Source stage: squared differences of two images (6.1, 6.2) summed over the 2·radius + 1 rows of
/// a window, cut to the image. Running integer sums are exact for any first row of a sweep, their
/// cost per cell does not depend on the radius, and no rows of costs are stored. This is why cost
/// and column sum are one stage: comparing the row that leaves the window again is cheaper than
/// loading its costs.
///
/// Output cells are int32_t, geometry.lanes() per column: the sum times 4^shift for 8-bit images,
/// in the unit of PreparedPair::prepare() for float ones. A cell whose partner is outside the other
/// image is 0 if a candidate's window of `radius` columns reaches it, and undefined farther out.
/// `partner` is mirrored for a left reference (geometry.direction = −1), plain for a right one; its
/// margins are those of PreparedPair::prepare(). Both planes must outlive the stage.
std::unique_ptr<scheduler::RowStage> make_column_ssd_stage(
    const IntensityPlane<std::uint8_t>& reference, const IntensityPlane<std::uint8_t>& partner,
    const kernels::CandidateGeometry& geometry, int height, int radius, int shift);
std::unique_ptr<scheduler::RowStage> make_column_ssd_stage(
    const IntensityPlane<float>& reference, const IntensityPlane<float>& partner,
    const kernels::CandidateGeometry& geometry, int height, int radius);

}  // namespace vantage
