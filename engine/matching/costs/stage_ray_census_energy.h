#pragma once

#include <memory>

#include "engine/matching/costs/cost_image.h"
#include "engine/matching/parameters/method_parameters.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Source stage: energies −ln p0 of ray census codes in bytes, geometry.lanes() a column, in the
/// steps of ray_census_energies(): what coarse levels are made of, in a tenth of the time that
/// likelihoods and their logarithms take. Lanes that are no candidates hold 255. Of one channel and
/// one partner at the map's own baseline; otherwise as make_cost_stage().
std::unique_ptr<scheduler::RowStage> make_ray_census_energy_stage(
    const MethodParameters& parameters, const kernels::CandidateGeometry& geometry,
    const CostImage& reference, const CostPartner& partner, int height);

}  // namespace vantage
