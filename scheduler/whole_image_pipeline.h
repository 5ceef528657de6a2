#pragma once

#include "scheduler/strip_plan.h"

namespace vantage::scheduler {

/// The reference executor of a chain: one stage after the other over the whole image, with every
/// row of every stage stored. Slow and simple: the oracle for tests of run_strips().
void run_whole_image(Chain chain);

}  // namespace vantage::scheduler
