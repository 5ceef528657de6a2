#pragma once

#include "engine/execution.h"

namespace vantage {

/// Measured peak performance of a machine: the roofs of a roofline. For the instruction set in use;
/// GFLOP/s in single precision, multiplication and addition counted as two; GB/s are 10⁹ bytes per
/// second.
struct MachineCeilings {
  int threads = 1;
  double core_gflops = 0;       ///< one thread alone
  double all_gflops = 0;        ///< all threads together
  double core_l2_gb_per_s = 0;  ///< loads from the level-2 cache by one thread
  double all_l2_gb_per_s = 0;
  double core_memory_gb_per_s = 0;  ///< loads and stores of the triad, without write-allocate loads
  double all_memory_gb_per_s = 0;
};

/// Measures for about `seconds` (> 0, usually 2). Takes the best of many short measurements each,
/// because other load on the machine can only reduce it.
MachineCeilings measure_ceilings(Execution& execution, double seconds);

}  // namespace vantage
