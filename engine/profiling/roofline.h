#pragma once

#include <optional>

#include "engine/profiling/profile.h"

namespace vantage {

/// What one of `threads` threads can count on while all of them work: its share of what they reach
/// together. A thread alone may get more of what they share.
struct ThreadRoofs {
  double gflops = 0;
  double l2_gb_per_s = 0;
  double memory_gb_per_s = 0;
};

/// All 0 where nothing was measured.
ThreadRoofs thread_roofs(const MachineCeilings& ceilings);

/// Of one of `threads` threads; none if they were not measured or are not positive.
std::optional<ThreadRoofs> roofs_on(const Profile& profile, int threads);

enum class Roof { kArithmetic, kL2 };

/// A stage below the roofs of the thread that runs it (Williams, Waterman and Patterson,
/// "Roofline", 2009). Rates are those of one thread while it is in the stage.
struct RooflinePlace {
  double operations_per_byte = 0;
  double gflops = 0;
  double gb_per_s = 0;
  /// The lower of both at its operations per byte. Stages count bytes whichever cache they lie in,
  /// and plans keep them in level 2: that is where its slope comes from. What moves more than level
  /// 2 delivers lies in level 1, and only arithmetic is above it.
  Roof roof = Roof::kArithmetic;
  double roof_gflops = 0;
  double roof_share = 0;    ///< gflops ÷ roof_gflops
  double memory_share = 0;  ///< gb_per_s ÷ what memory delivers; above 1 most of it is in caches
};

/// None if the stage does not know its operations and bytes, or took no time.
std::optional<RooflinePlace> place_on_roofline(const StageProfile& stage, const ThreadRoofs& roofs);

}  // namespace vantage
