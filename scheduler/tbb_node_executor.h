#pragma once

#include <memory>

#include "scheduler/executor.h"
#include "scheduler/thread_places.h"

namespace vantage::scheduler {

/// TBB threads in an arena per NUMA node of `places`. Loops are divided into a range of tasks per
/// node; frames live on the node of their slot, and so do loops within them, if there is a slot for
/// each node and frames need not be computed in order.
std::unique_ptr<Executor> make_tbb_node_executor(const ThreadPlaces& places);

}  // namespace vantage::scheduler
