#pragma once

#include "engine/profiling/profile.h"

namespace vantage {

// What a stage's counts come to; 0 where it does not know what a figure is made of. Rates are of
// one thread, as its seconds are processor time. Thread rule: pure.

double cells_per_second(const StageProfile& stage);
double nanoseconds_per_cell(const StageProfile& stage);
/// Columns made beyond those that are results, as a share of these: halo, rows that warm up running
/// sums, and what is made again in a later pass.
double halo_share(const StageProfile& stage);
double gflops(const StageProfile& stage);
double gb_per_second(const StageProfile& stage);
/// The stage's part of the work of the pool's threads, or of the time of all stages if that is
/// more.
double work_share(const StageProfile& stage, const ThreadCountProfile& count);

}  // namespace vantage
