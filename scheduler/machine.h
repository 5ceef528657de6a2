#pragma once

#include <cstddef>
#include <string>

namespace vantage::scheduler {

/// Properties of the machine, for the planner. Cache sizes are those of one instance.
struct Machine {
  std::string processor = "unknown processor";  ///< model name
  int hardware_threads = 1;  ///< that this process may use (affinity mask and cgroup masks count)
  int cores = 1;
  int numa_nodes = 1;
  std::size_t l1_data_bytes = 32 * 1024;
  std::size_t l2_bytes = 512 * 1024;
  std::size_t l3_bytes = 0;
  std::size_t memory_bytes = 0;
};

/// Queries hwloc. Values that hwloc does not know keep the defaults above.
Machine detect_machine();

}  // namespace vantage::scheduler
