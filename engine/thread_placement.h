#pragma once

#include <string_view>

#include "engine/execution.h"
#include "scheduler/thread_places.h"
#include "scheduler/topology.h"

namespace vantage {

/// Where the threads of an Execution with `options` run on a machine with `topology`.
scheduler::ThreadPlaces thread_places(const ExecutionOptions& options,
                                      const scheduler::Topology& topology);

/// "none", "node" or "core".
std::string_view name_of(scheduler::ThreadBinding binding);

}  // namespace vantage
