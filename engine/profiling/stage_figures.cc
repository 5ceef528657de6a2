#include "engine/profiling/stage_figures.h"

#include <algorithm>

#include "engine/profiling/profile_figures.h"

namespace vantage {
namespace {

double per_second(double amount, const StageProfile& stage) {
  return stage.seconds.median > 0 ? amount / stage.seconds.median : 0;
}

}  // namespace

double cells_per_second(const StageProfile& stage) { return per_second(stage.cells, stage); }

double nanoseconds_per_cell(const StageProfile& stage) {
  return stage.cells > 0 ? stage.seconds.median * 1e9 / stage.cells : 0;
}

double halo_share(const StageProfile& stage) {
  return stage.own_columns > 0 ? stage.columns / stage.own_columns - 1 : 0;
}

double gflops(const StageProfile& stage) { return per_second(stage.operations, stage) * 1e-9; }

double gb_per_second(const StageProfile& stage) { return per_second(stage.bytes, stage) * 1e-9; }

double work_share(const StageProfile& stage, const ThreadCountProfile& count) {
  const double all_s = std::max(pool_work_s(count), stages_s(count));
  return all_s > 0 ? stage.seconds.median / all_s : 0;
}

}  // namespace vantage
