// The machine, and threads on it, for a build without hwloc, in place of topology.cc and
// bound_thread.cc: one node, caches as Machine assumes them, no binding.
#include <algorithm>
#include <stdexcept>
#include <thread>

#include "scheduler/bound_thread.h"
#include "scheduler/control_groups.h"
#include "scheduler/topology.h"

namespace vantage::scheduler {

Topology detect_topology() {
  const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const SystemLimits limits = read_system_limits();
  Topology topology;
  topology.machine.hardware_threads = limits.threads_of(threads);
  topology.machine.cores = threads;
  topology.machine.memory_bytes = limits.memory_bytes;
  NumaNode& node = topology.nodes.emplace_back();
  node.memory_bytes = limits.memory_bytes;
  for (int thread = 0; thread < threads; ++thread) {
    node.cores.push_back({thread});
  }
  return topology;
}

Topology synthetic_topology(const std::string& description) {
  throw std::invalid_argument("'" + description + "' needs hwloc, which this build is without");
}

BoundThread::BoundThread(std::shared_ptr<hwloc_topology> /*system*/,
                         const std::vector<int>& /*allowed*/) {}
BoundThread::~BoundThread() = default;

}  // namespace vantage::scheduler
