#pragma once

#include <memory>

#include "scheduler/executor.h"

namespace vantage::scheduler {

/// One team of `threads` OpenMP threads for strips and frames alike.
std::unique_ptr<Executor> make_openmp_executor(int threads);

}  // namespace vantage::scheduler
