#pragma once

#include <memory>

#include "scheduler/executor.h"

namespace vantage::scheduler {

/// Only in builds with the thread sanitizer: an executor that works like `inner` and tells the
/// sanitizer of the order that Executor promises. TBB and libgomp synchronise inside libraries that
/// the sanitizer cannot see into; without this it would take every result of a task for a race.
std::unique_ptr<Executor> with_declared_order(std::unique_ptr<Executor> inner);

}  // namespace vantage::scheduler
