#pragma once

#include <cstddef>
#include <string>

namespace vantage::scheduler {

/// What the planner knows of the machine. Sizes in bytes of one instance of the cache.
struct Machine {
  std::string processor = "unknown processor";  ///< as its maker calls the model
  int hardware_threads = 1;  ///< that this process may use (affinity mask and cgroup masks count)
  int cores = 1;
  int numa_nodes = 1;
  std::size_t l1_data_bytes = 32 * 1024;
  std::size_t l2_bytes = 512 * 1024;
  std::size_t l3_bytes = 0;
  std::size_t memory_bytes = 0;
};

/// Asks hwloc. What it cannot tell keeps the default above.
Machine detect_machine();

}  // namespace vantage::scheduler
