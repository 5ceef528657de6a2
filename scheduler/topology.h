#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "scheduler/machine.h"

struct hwloc_topology;

namespace vantage::scheduler {

/// Hardware threads that share a core, as the system numbers them; never empty.
using Core = std::vector<int>;

/// Memory and the cores next to it.
struct NumaNode {
  int number = 0;  ///< as the system counts nodes
  std::vector<Core> cores;
  std::size_t memory_bytes = 0;

  [[nodiscard]] int hardware_threads() const;
};

/// The part of a machine that this process may use: its affinity mask and cgroups count.
struct Topology {
  Machine machine;
  std::vector<NumaNode> nodes;  ///< those with cores, at least one
  /// hwloc's, for binding threads. Null where `nodes` are not those of the system that this process
  /// runs on.
  std::shared_ptr<hwloc_topology> system;
};

/// Asks hwloc, which obeys HWLOC_SYNTHETIC and HWLOC_XMLFILE: such topologies are planned for, but
/// no thread is bound to what may not be there. What hwloc cannot tell keeps Machine's defaults.
Topology detect_topology();

/// The one that `description` stands for, in hwloc's notation ("pack:2 core:4 pu:2"). Throws
/// std::invalid_argument.
Topology synthetic_topology(const std::string& description);

}  // namespace vantage::scheduler
