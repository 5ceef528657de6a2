#pragma once

#include "engine/profiling/profile.h"

namespace vantage {

// Derived figures of a stage; 0 if their inputs are unknown. Rates are per thread, because its
// seconds are processor time. Thread rule: pure.

double cells_per_second(const StageProfile& stage);
double nanoseconds_per_cell(const StageProfile& stage);
/// Columns computed beyond the results, relative to the results: halo, rows that warm up running
/// sums, and recomputation in a later pass.
double halo_share(const StageProfile& stage);
double gflops(const StageProfile& stage);
double gb_per_second(const StageProfile& stage);
/// Share of the stage in the work of the pool's threads, or in the time of all stages if that is
/// more.
double work_share(const StageProfile& stage, const ThreadCountProfile& count);

}  // namespace vantage
