#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "scheduler/machine.h"

struct hwloc_topology;

namespace vantage::scheduler {

/// The system's numbers of the hardware threads of a core; never empty.
using Core = std::vector<int>;

/// A NUMA node: memory and its local cores.
struct NumaNode {
  int number = 0;  ///< the system's number of the node
  std::vector<Core> cores;
  std::size_t memory_bytes = 0;

  [[nodiscard]] int hardware_threads() const;
};

/// The part of a machine that this process may use: its affinity mask and cgroups count.
struct Topology {
  Machine machine;
  std::vector<NumaNode> nodes;  ///< those with cores, at least one
  /// hwloc's topology, for binding threads. Null if `nodes` are not those of the system that this
  /// process runs on.
  std::shared_ptr<hwloc_topology> system;
};

/// Queries hwloc and, for this system, its control groups. hwloc obeys HWLOC_SYNTHETIC and
/// HWLOC_XMLFILE: plans use such topologies, but no thread is bound to them. Values that hwloc does
/// not know keep Machine's defaults.
Topology detect_topology();

/// The topology of `description` in hwloc's notation ("pack:2 core:4 pu:2"). Throws
/// std::invalid_argument.
Topology synthetic_topology(const std::string& description);

}  // namespace vantage::scheduler
