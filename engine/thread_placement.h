#pragma once

#include <string_view>
#include <vector>

#include "engine/execution.h"
#include "engine/remark.h"
#include "scheduler/thread_places.h"
#include "scheduler/topology.h"

namespace vantage {

/// Where the threads of an Execution with `options` run on a machine with `topology`.
scheduler::ThreadPlaces thread_places(const ExecutionOptions& options,
                                      const scheduler::Topology& topology);

/// A note where an Execution with `options` has fewer threads than asked for:
/// kMaxThreadsPerProcessor.
std::vector<Remark> thread_remarks(const ExecutionOptions& options,
                                   const scheduler::Machine& machine);

/// "none", "node" or "core".
std::string_view name_of(scheduler::ThreadBinding binding);

}  // namespace vantage
