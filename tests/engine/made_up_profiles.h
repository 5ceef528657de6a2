#pragma once

#include "engine/profiling/profile.h"

namespace vantage {

/// Profiles with figures that were thought up, for tests of what shows them.

/// A match with Bayesian diffusion on 1 and 2 threads.
Profile made_up_match();

/// A run of 200 frames on 1, 2, 4, 8 and 16 threads.
Profile made_up_run();

}  // namespace vantage
