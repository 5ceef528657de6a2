#pragma once

#include <memory>
#include <vector>

#include "engine/matching/aggregation/edge_weights.h"
#include "engine/matching/levels/candidate_blocks.h"
#include "engine/matching/levels/stage_from_coarser.h"
#include "engine/matching/parameters/method_parameters.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// The stages of Bayesian diffusion with the largest term of the prior's sum (6.35) instead of the
/// sum (kernels/max_product_step), after a first stage with energies −ln p0 (stage_fixed_energies):
/// a start, then one stage per iteration. Cells are kernels::FixedEnergy of
/// EnergyFormat(parameters), geometry.lanes() per column; the last stage's are energies −ln p above
/// the minimum of their column.
///
/// `coarser`: the final energies of the next coarser level (make_level_fixed_energy_result_stage);
/// must outlive the stages. The start is then made from it instead of the first stage's energies,
/// which only the iterations read.
///
/// `blocks`: the candidates processed; cells of all stages lie in their lanes, and all other
/// candidates have the energy of the ceiling. Null: all; required without a coarser level and with
/// `plane`. Must outlive the stages.
///
/// `edges`, `plane`: as in make_bayes_stages(), prepared with the same parameters.
std::vector<std::unique_ptr<scheduler::RowStage>> make_max_product_stages(
    const MethodParameters& parameters, const kernels::CandidateGeometry& geometry, int height,
    const CoarserResult& coarser = {}, const EdgeWeights* edges = nullptr,
    const CandidateBlocks* blocks = nullptr, const kernels::CandidatePlane& plane = {});

}  // namespace vantage
