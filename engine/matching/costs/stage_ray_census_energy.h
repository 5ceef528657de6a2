#pragma once

#include <memory>

#include "engine/matching/costs/cost_image.h"
#include "engine/matching/parameters/method_parameters.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Source stage: energies −ln p0 of ray census codes in bytes, geometry.lanes() per column, in the
/// steps of ray_census_energies(). Coarse levels are computed from them, in a tenth of the time of
/// likelihoods and their logarithms. Lanes beyond the candidates hold 255. For one channel and one
/// partner at the map's own baseline; otherwise as make_cost_stage().
std::unique_ptr<scheduler::RowStage> make_ray_census_energy_stage(
    const MethodParameters& parameters, const kernels::CandidateGeometry& geometry,
    const CostImage& reference, const CostPartner& partner, int height);

}  // namespace vantage
