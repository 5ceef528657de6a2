#pragma once

#include <memory>

#include "engine/matching/aggregation/edge_weights.h"
#include "engine/matching/parameters/method_parameters.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// One simultaneous (Jacobi) iteration of linear diffusion (6.7), or of the membrane (6.9) if
/// `parameters.aggregation` says so. Cells are energies, float, geometry.lanes() per column;
/// neighbours outside the image are left out. The membrane pulls towards the chain's first stage,
/// which must be the cost stage with the energies E0.
///
/// `edges`: weights of neighbours in this iteration (7.3), E ← E + λ Σ w_n (E_n − E); must outlive
/// the stages. Null: all weights are 1.
std::unique_ptr<scheduler::RowStage> make_diffusion_stage(
    const MethodParameters& parameters, const kernels::CandidateGeometry& geometry, int height,
    const EdgeWeightPlanes* edges = nullptr);

/// Position of an iteration in its chain.
struct IterationPlace {
  bool is_first = false;
  bool is_last = false;
};

/// One iteration of diffusion with local stopping (6.4). Between iterations a column also holds its
/// certainty and is one cache line longer than its cells; the first input and the last output are
/// cells only. `edges`: as above.
std::unique_ptr<scheduler::RowStage> make_local_stopping_stage(
    const MethodParameters& parameters, const kernels::CandidateGeometry& geometry, int height,
    IterationPlace place, const EdgeWeightPlanes* edges = nullptr);

}  // namespace vantage
