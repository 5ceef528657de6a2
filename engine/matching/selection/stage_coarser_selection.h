#pragma once

#include <memory>

#include "engine/matching/levels/candidate_blocks.h"
#include "engine/matching/levels/energy_format.h"
#include "engine/matching/levels/stage_from_coarser.h"
#include "engine/matching/selection/energy_selector.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// The only stage of a finest level without iterations: its energies are those of the coarser
/// level, so winners are selected once for each of its columns and written to 2×2 pixels. Only
/// pixels some of whose candidates have no partner are selected one by one. Rows of the stage are
/// those of the coarser level. Equal to the start from the coarser level followed by
/// make_fixed_energy_selection_stage(). `geometry`, `height`: of the image. `blocks`: the image's
/// candidates processed; null: all. Volumes and blocks must outlive the stage.
std::unique_ptr<scheduler::RowStage> make_coarser_selection_stage(
    const kernels::CandidateGeometry& geometry, int height, const EnergySelector& selector,
    const EnergyFormat& format, const CoarserResult& coarser, const CandidateBlocks* blocks);

}  // namespace vantage
