#pragma once

#include <memory>

#include "scheduler/executor.h"
#include "scheduler/thread_places.h"

namespace vantage::scheduler {

/// One team of OpenMP threads for strips and frames alike, bound as `places` says while they work.
/// Loops are divided into a range of tasks per node; frames run on any.
std::unique_ptr<Executor> make_openmp_executor(const ThreadPlaces& places);

}  // namespace vantage::scheduler
