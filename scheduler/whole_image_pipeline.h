#pragma once

#include "scheduler/strip_plan.h"

namespace vantage::scheduler {

/// The plain executor of a chain: one stage after the other over the whole image, every row of
/// every stage stored. Slow and large, and obviously right: what run_strips() is tested against.
void run_whole_image(Chain chain);

}  // namespace vantage::scheduler
