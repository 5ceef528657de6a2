#pragma once

#include <memory>
#include <vector>

#include "engine/matching/costs/displacement_grid.h"
#include "engine/matching/parameters/method_parameters.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Source stage: the cells of all displacements of a grid. `of_rows` holds, per vertical disparity,
/// a source stage for the horizontal ones. All have the same cell size and none depends on other
/// rows. Lanes after the candidates are filled with bytes of `padding`.
std::unique_ptr<scheduler::RowStage> make_displacement_cost_stage(
    std::vector<std::unique_ptr<scheduler::RowStage>> of_rows, const DisplacementGrid& grid,
    unsigned char padding);

/// Source stage: likelihoods of evidence, CellMeaning::kLikelihood of the cost gradient, from
/// `evidence`, a source stage whose cells are the negated evidence of all displacements of a grid:
/// each is compared with the best one that has a partner.
std::unique_ptr<scheduler::RowStage> make_displacement_evidence_stage(
    std::unique_ptr<scheduler::RowStage> evidence, const DisplacementGrid& grid,
    const MethodParameters& parameters);

}  // namespace vantage
