#include "engine/thread_placement.h"

namespace vantage {

scheduler::ThreadPlaces thread_places(const ExecutionOptions& options,
                                      const scheduler::Topology& topology) {
  const int threads = thread_count(options, topology.machine);
  if (options.executor == scheduler::ExecutorKind::kSerial) {
    return scheduler::unbound_threads(threads);
  }
  return scheduler::place_threads(
      topology, threads, options.binding.value_or(scheduler::default_binding(topology, threads)));
}

std::string_view name_of(scheduler::ThreadBinding binding) {
  switch (binding) {
    case scheduler::ThreadBinding::kNone:
      return "none";
    case scheduler::ThreadBinding::kNodes:
      return "node";
    case scheduler::ThreadBinding::kCores:
      return "core";
  }
  return "";
}

}  // namespace vantage
