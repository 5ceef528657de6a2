#pragma once

#include <memory>
#include <vector>

#include "engine/matching/aggregation/edge_weights.h"
#include "engine/matching/levels/candidate_blocks.h"
#include "engine/matching/levels/stage_from_coarser.h"
#include "engine/matching/options/method_parameters.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// The stages of Bayesian diffusion with the largest term of the prior's sum (6.35) in place of the
/// sum (kernels/max_product_step), after a first stage that makes energies −ln p0
/// (stage_fixed_energies): a start, then one stage an iteration. Cells are kernels::FixedEnergy of
/// EnergyFormat(parameters), geometry.lanes() a column; the last stage's are energies −ln p above
/// the least of their column.
///
/// `coarser`, the energies that the next coarser level ended with (make_level_energy_result_stage),
/// must outlive the stages; the start is made of it instead of the first stage's energies, which
/// then only the iterations look at.
///
/// `blocks`: the candidates that are looked at, in whose lanes the cells of all stages lie; all
/// others have the energy of the ceiling. Null: all, and always so without a coarser level and with
/// `plane`. Must outlive the stages.
///
/// `edges`, `plane`: as make_bayes_stages() takes them, prepared with the same parameters.
std::vector<std::unique_ptr<scheduler::RowStage>> make_max_product_stages(
    const MethodParameters& parameters, const kernels::CandidateGeometry& geometry, int height,
    const CoarserResult& coarser = {}, const EdgeWeights* edges = nullptr,
    const CandidateBlocks* blocks = nullptr, const kernels::CandidatePlane& plane = {});

}  // namespace vantage
