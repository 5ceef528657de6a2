#include "engine/thread_placement.h"

#include <fmt/format.h>

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

std::vector<Remark> thread_remarks(const ExecutionOptions& options,
                                   const scheduler::Machine& machine) {
  const int asked = options.threads.value_or(1);
  const int used = thread_count(options, machine);
  if (options.executor == scheduler::ExecutorKind::kSerial || asked <= used) {
    return {};
  }
  const int processors = machine.hardware_threads;
  return {
      {Remark::Kind::kNote, "threads",
       fmt::format("`threads` {} for {} processor{}: {} are used, more would only look for work",
                   asked, processors, processors == 1 ? "" : "s", used)}};
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
