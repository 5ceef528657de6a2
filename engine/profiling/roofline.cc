#include "engine/profiling/roofline.h"

#include <algorithm>
#include <cmath>

#include "engine/profiling/stage_figures.h"

namespace vantage {
namespace {

bool is_positive(double value) { return value > 0 && std::isfinite(value); }

}  // namespace

ThreadRoofs thread_roofs(const MachineCeilings& ceilings) {
  const double threads = std::max(1, ceilings.threads);
  return {.gflops = ceilings.all_gflops / threads,
          .l2_gb_per_s = ceilings.all_l2_gb_per_s / threads,
          .memory_gb_per_s = ceilings.all_memory_gb_per_s / threads};
}

std::optional<ThreadRoofs> roofs_on(const Profile& profile, int threads) {
  const auto found = std::ranges::find(profile.ceilings, threads, &MachineCeilings::threads);
  if (found == profile.ceilings.end()) {
    return std::nullopt;
  }
  const ThreadRoofs roofs = thread_roofs(*found);
  if (!is_positive(roofs.gflops) || !is_positive(roofs.l2_gb_per_s) ||
      !is_positive(roofs.memory_gb_per_s)) {
    return std::nullopt;
  }
  return roofs;
}

std::optional<RooflinePlace> place_on_roofline(const StageProfile& stage,
                                               const ThreadRoofs& roofs) {
  if (!is_positive(stage.seconds.median) || !is_positive(stage.operations) ||
      !is_positive(stage.bytes)) {
    return std::nullopt;
  }
  RooflinePlace place;
  place.operations_per_byte = stage.operations / stage.bytes;
  place.gflops = gflops(stage);
  place.gb_per_s = gb_per_second(stage);
  const double l2_gflops = place.operations_per_byte * roofs.l2_gb_per_s;
  const bool is_in_l1 = place.gb_per_s > roofs.l2_gb_per_s;
  place.roof = is_in_l1 || roofs.gflops <= l2_gflops ? Roof::kArithmetic : Roof::kL2;
  place.roof_gflops = place.roof == Roof::kArithmetic ? roofs.gflops : l2_gflops;
  place.roof_share = place.roof_gflops > 0 ? place.gflops / place.roof_gflops : 0;
  place.memory_share = roofs.memory_gb_per_s > 0 ? place.gb_per_s / roofs.memory_gb_per_s : 0;
  return place;
}

}  // namespace vantage
