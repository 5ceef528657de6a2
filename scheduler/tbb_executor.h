#pragma once

#include <memory>
#include <string>

#include "scheduler/executor.h"

namespace vantage::scheduler {

/// One arena of `threads` TBB threads, for strips and for frames.
std::unique_ptr<Executor> make_tbb_executor(int threads);

/// Version of the TBB library in use.
std::string tbb_version();

}  // namespace vantage::scheduler
