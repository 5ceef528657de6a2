#include "engine/profiling/stage_figures.h"

namespace vantage {

double cells_per_second(const StageProfile& stage) {
  return stage.seconds.median > 0 ? stage.cells / stage.seconds.median : 0;
}

double nanoseconds_per_cell(const StageProfile& stage) {
  return stage.cells > 0 ? stage.seconds.median * 1e9 / stage.cells : 0;
}

double halo_share(const StageProfile& stage) {
  return stage.own_columns > 0 ? stage.columns / stage.own_columns - 1 : 0;
}

}  // namespace vantage
