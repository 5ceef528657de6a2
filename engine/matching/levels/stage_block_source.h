#pragma once

#include <memory>
#include <vector>

#include "engine/matching/levels/candidate_blocks.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Source stage that makes the cells of the blocks that `blocks` says: `of_blocks` holds a source
/// stage for each block of candidates, all with cells of one size, kLaneMultiple a column, none of
/// which depends on other rows or blocks. Output cells are of that size, blocks.lanes() a column.
/// `blocks` must outlive the stage.
std::unique_ptr<scheduler::RowStage> make_block_source_stage(
    std::vector<std::unique_ptr<scheduler::RowStage>> of_blocks, const CandidateBlocks& blocks);

}  // namespace vantage
