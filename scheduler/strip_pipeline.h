#pragma once

#include <span>

#include "scheduler/executor.h"
#include "scheduler/scratch_pool.h"
#include "scheduler/strip_plan.h"

namespace vantage::scheduler {

/// Runs `chain` according to `plan`. In each pass, strips × bands are independent tasks of
/// `executor`; in a task the stages move down the image as a wavefront over rings of rows. Blocks
/// until done. Rethrows the first error of a stage. Results equal those of run_whole_image().
void run_strips(Chain chain, const ChainPlan& plan, Executor& executor, ScratchPool& scratch);

/// Makes only `regions` of the last stage's output: each, with its halo, as a task. Regions do not
/// overlap. Results equal those parts of run_whole_image().
void run_regions(Chain chain, std::span<const Region> regions, Executor& executor,
                 ScratchPool& scratch);

}  // namespace vantage::scheduler
