#pragma once

#include <memory>
#include <vector>

#include "engine/matching/levels/candidate_blocks.h"
#include "engine/matching/levels/stage_fixed_energies.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Source stage: the energies −ln p0 of `blocks`, blocks.lanes() per column; `of_blocks` holds a
/// source stage with the costs of each block of candidates, kLaneMultiple cells per column,
/// independent of other rows and blocks; `count`: all candidates. `blocks` must outlive the stage.
std::unique_ptr<scheduler::RowStage> make_block_source_stage(
    std::vector<std::unique_ptr<scheduler::RowStage>> of_blocks, const EnergyConversion& conversion,
    int count, const CandidateBlocks& blocks);

}  // namespace vantage
