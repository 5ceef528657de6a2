#pragma once

#include <memory>

#include "scheduler/executor.h"

namespace vantage::scheduler {

/// Only in builds with the thread sanitizer: an executor that works like `inner` and declares the
/// order that Executor guarantees. TBB and libgomp synchronise inside libraries that the sanitizer
/// does not instrument; without this it would report every result of a task as a race.
std::unique_ptr<Executor> with_declared_order(std::unique_ptr<Executor> inner);

}  // namespace vantage::scheduler
