#include "engine/profiling/roofline.h"

#include <algorithm>

namespace vantage {

std::optional<RooflinePoint> roofline_point(const StageProfile& stage,
                                            const MachineCeilings& ceilings) {
  const double seconds = stage.seconds.median;
  if (!(seconds > 0 && stage.operations > 0 && stage.bytes > 0)) {
    return std::nullopt;
  }
  const int threads = std::max(1, ceilings.threads);
  const double peak_gflops = ceilings.all_gflops / threads;
  RooflinePoint point;
  point.gflops = stage.operations / seconds * 1e-9;
  point.gb_per_s = stage.bytes / seconds * 1e-9;
  point.operations_per_byte = stage.operations / stage.bytes;
  const double from_cache = point.operations_per_byte * ceilings.all_l2_gb_per_s / threads;
  point.bound = from_cache < peak_gflops ? RooflineBound::kLevel2 : RooflineBound::kArithmetic;
  point.bound_gflops = std::min(peak_gflops, from_cache);
  return point;
}

std::string_view name_of(RooflineBound bound) {
  return bound == RooflineBound::kLevel2 ? "level-2 cache" : "arithmetic";
}

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
