#pragma once

#include <atomic>

#include "scheduler/executor.h"
#include "scheduler/scratch_pool.h"
#include "scheduler/strip_plan.h"

namespace vantage::scheduler {

/// Runs `chain` according to `plan`. In each pass, strips × bands are independent tasks of
/// `executor`; in a task the stages move down the image as a wavefront over rings of rows. Blocks
/// until done. Rethrows the first error of a stage. Results equal those of run_whole_image().
void run_strips(Chain chain, const ChainPlan& plan, Executor& executor, ScratchPool& scratch);

}  // namespace vantage::scheduler
