#pragma once

#include <memory>

#include "scheduler/executor.h"
#include "scheduler/thread_places.h"

namespace vantage::scheduler {

/// TBB threads in one arena per NUMA node of `places`. A loop is divided into a range of tasks per
/// node. Frames stay on the node of their slot; so do their loops, if there is a slot for each node
/// and frames need not be computed in order.
std::unique_ptr<Executor> make_tbb_node_executor(const ThreadPlaces& places);

}  // namespace vantage::scheduler
