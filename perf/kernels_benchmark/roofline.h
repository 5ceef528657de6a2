#pragma once

#include "perf/kernels_benchmark/kernel_benchmark.h"

namespace vantage::perf {

/// Peak rates of one thread on one instruction set, with data in the level 1 cache.
struct CoreCeilings {
  double operations_per_s = 0;  ///< float multiply-adds, two operations each
  double bytes_per_s = 0;       ///< the faster of loads alone and the triad
};

/// Measured on the first call for an instruction set, which must be the one in use.
const CoreCeilings& ceilings_of(long long target);

/// Minimum time for one unit of `work`: the larger of the times for its operations and its bytes. 0
/// if nothing is counted.
double min_seconds(const UnitWork& work, const CoreCeilings& ceilings);

/// Whether arithmetic, not loads and stores, determines that time.
bool is_bound_by_arithmetic(const UnitWork& work, const CoreCeilings& ceilings);

}  // namespace vantage::perf
