#pragma once

#include "perf/kernels_benchmark/kernel_benchmark.h"

namespace vantage::perf {

/// What one thread can do at best on one instruction set, data in the level-1 cache.
struct CoreCeilings {
  double operations_per_s = 0;  ///< multiplying and adding floats, two each
  double bytes_per_s = 0;       ///< loading, or loading and storing as the triad, whichever is more
};

/// Measured when an instruction set is asked for the first time; it must be the one in use.
const CoreCeilings& ceilings_of(long long target);

/// Least time in which a unit of `work` can be done: that of its operations or of its bytes,
/// whichever is more. 0 where nothing is counted.
double least_seconds(const UnitWork& work, const CoreCeilings& ceilings);

/// Whether arithmetic and not loads and stores make that time.
bool is_bound_by_arithmetic(const UnitWork& work, const CoreCeilings& ceilings);

}  // namespace vantage::perf
