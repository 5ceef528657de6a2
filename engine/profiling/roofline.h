#pragma once

#include <optional>
#include <string_view>

#include "engine/profiling/profile.h"

namespace vantage {

/// What keeps a stage from being faster than its roof.
enum class RooflineBound { kArithmetic, kLevel2 };

/// Where a stage lies under the roofs of one thread, with all threads at work: a stage's seconds
/// are processor time, so its rates are those of a thread.
struct RooflinePoint {
  double gflops = 0;
  double gb_per_s = 0;
  double operations_per_byte = 0;
  /// The least of the arithmetic peak and of what the level-2 cache delivers at this intensity. The
  /// rows that a stage works on are planned to stay in that cache; what the level-1 cache serves
  /// may be above this roof.
  double bound_gflops = 0;
  RooflineBound bound = RooflineBound::kArithmetic;

  /// Share of the roof that is reached; 0 without a roof.
  [[nodiscard]] double share() const { return bound_gflops > 0 ? gflops / bound_gflops : 0; }
};

/// None for a stage that took no time or does not know its work. Thread rule: pure.
std::optional<RooflinePoint> roofline_point(const StageProfile& stage,
                                            const MachineCeilings& ceilings);

/// "arithmetic", "level-2 cache"
std::string_view name_of(RooflineBound bound);

// Further figures of a stage; 0 where it does not know what they are made of.
double cells_per_second(const StageProfile& stage);  ///< of a thread
double nanoseconds_per_cell(const StageProfile& stage);
/// Columns made beyond those that are results, as a share of these.
double halo_share(const StageProfile& stage);

}  // namespace vantage
