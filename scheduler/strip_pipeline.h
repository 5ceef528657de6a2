#pragma once

#include <atomic>

#include "scheduler/executor.h"
#include "scheduler/scratch_pool.h"
#include "scheduler/strip_plan.h"

namespace vantage::scheduler {

/// Runs `chain` as `plan` says: per pass, strips × bands are independent tasks of `executor`; in a
/// task the stages follow each other down the image as a wavefront over rings of rows. Blocks until
/// done. Rethrows the first error of a stage. The results are those of run_whole_image().
void run_strips(Chain chain, const ChainPlan& plan, Executor& executor, ScratchPool& scratch);

}  // namespace vantage::scheduler
