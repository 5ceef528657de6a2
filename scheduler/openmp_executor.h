#pragma once

#include <memory>

#include "scheduler/executor.h"
#include "scheduler/thread_places.h"

namespace vantage::scheduler {

/// One team of OpenMP threads for strips and frames, bound to `places` while they work. A loop is
/// divided into one range of tasks per node; frames run on any node.
std::unique_ptr<Executor> make_openmp_executor(const ThreadPlaces& places);

}  // namespace vantage::scheduler
