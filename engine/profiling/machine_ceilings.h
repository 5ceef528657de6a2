#pragma once

#include "engine/execution.h"

namespace vantage {

/// What a machine can do at best, measured: the roofs of a roofline. Of the instruction set in
/// use; GFLOP/s in single precision, multiplication and addition counted as two; GB/s are 10⁹
/// bytes a second.
struct MachineCeilings {
  int threads = 1;
  double core_gflops = 0;       ///< one thread alone
  double all_gflops = 0;        ///< all threads together
  double core_l2_gb_per_s = 0;  ///< loads from the level-2 cache by one thread
  double all_l2_gb_per_s = 0;
  double core_memory_gb_per_s = 0;  ///< the triad's loads and stores, without loads for stores
  double all_memory_gb_per_s = 0;

  bool operator==(const MachineCeilings&) const = default;
};

/// Measures for about `seconds` (> 0, usually 2). The best of many short measurements each, as
/// whatever else the machine does only takes away.
MachineCeilings measure_ceilings(Execution& execution, double seconds);

}  // namespace vantage
