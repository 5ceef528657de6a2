#pragma once

#include <optional>

#include "engine/profiling/profile.h"

namespace vantage {

/// Roofs of one of `threads` threads while all of them work: its share of their total. A thread
/// alone may get more of the shared resources.
struct ThreadRoofs {
  double gflops = 0;
  double l2_gb_per_s = 0;
  double memory_gb_per_s = 0;
};

/// All 0 if nothing was measured.
ThreadRoofs thread_roofs(const MachineCeilings& ceilings);

/// Roofs of one of `threads` threads; empty if not measured or not positive.
std::optional<ThreadRoofs> roofs_on(const Profile& profile, int threads);

enum class Roof { kArithmetic, kL2 };

/// A stage in the roofline model (Williams, Waterman and Patterson, "Roofline", 2009). Rates are
/// those of one thread while it is in the stage.
struct RooflinePlace {
  double operations_per_byte = 0;
  double gflops = 0;
  double gb_per_s = 0;
  /// The lower of both at its operations per byte. Stages count bytes from any cache level, and
  /// plans keep them in level 2, which therefore defines the slope. Stages that move more than
  /// level 2 delivers are in level 1 and bounded by arithmetic only.
  Roof roof = Roof::kArithmetic;
  double roof_gflops = 0;
  double roof_share = 0;    ///< gflops ÷ roof_gflops
  double memory_share = 0;  ///< gb_per_s ÷ memory bandwidth; above 1 most of it is in caches
};

/// Empty if the stage does not know its operations and bytes, or took no time.
std::optional<RooflinePlace> place_on_roofline(const StageProfile& stage, const ThreadRoofs& roofs);

}  // namespace vantage
