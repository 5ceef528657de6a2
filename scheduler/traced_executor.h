#pragma once

#include <memory>

#include "scheduler/executor.h"

namespace vantage::scheduler {

/// An executor that works like `inner`, charges the processor time of tasks as their loop's
/// (ProcessorCharge) and, while a Trace is active, records every task and every
/// step of a frame as work, and every loop and pipeline as a join. Tasks are named after the span
/// in which their loop started.
std::unique_ptr<Executor> with_tracing(std::unique_ptr<Executor> inner);

}  // namespace vantage::scheduler
