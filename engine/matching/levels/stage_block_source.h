#pragma once

#include <memory>
#include <vector>

#include "engine/matching/levels/candidate_blocks.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Source stage for the cells of `blocks`: `of_blocks` holds a source stage for each block of
/// candidates, all with cells of one size, kLaneMultiple per column, independent of other rows and
/// blocks. Output cells have that size, blocks.lanes() per column. `blocks` must outlive the stage.
std::unique_ptr<scheduler::RowStage> make_block_source_stage(
    std::vector<std::unique_ptr<scheduler::RowStage>> of_blocks, const CandidateBlocks& blocks);

}  // namespace vantage
