#pragma once

#include <memory>
#include <vector>

#include "engine/matching/aggregation/aggregation_place.h"
#include "engine/matching/parameters/method_parameters.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// The stages of Bayesian diffusion with the largest term of the prior's sum (6.35) instead of the
/// sum (kernels/max_product_step), after a first stage with energies −ln p0 (stage_fixed_energies):
/// a start, then one stage per iteration. Cells are kernels::FixedEnergy of
/// EnergyFormat(parameters), geometry.lanes() per column; the last stage's are energies −ln p above
/// the minimum of their column.
///
/// `place.coarser`: the final energies of the next coarser level
/// (make_level_fixed_energy_result_stage). The start is then made from it instead of the first
/// stage's energies, which only the iterations read.
///
/// `place.blocks`: the candidates processed; cells of all stages lie in their lanes, and all other
/// candidates have the energy of the ceiling. None without a coarser level and with `plane`.
///
/// `place.edges`, `place.plane`: as in make_bayes_stages(), prepared with the same parameters.
std::vector<std::unique_ptr<scheduler::RowStage>> make_max_product_stages(
    const MethodParameters& parameters, const AggregationPlace& place);

}  // namespace vantage
