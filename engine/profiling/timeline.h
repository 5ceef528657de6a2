#pragma once

#include <vector>

#include "engine/profiling/profile.h"
#include "scheduler/trace.h"

namespace vantage {

/// Timeline of the threads of a trace whose waits have been added, one row each. Where pieces are
/// too short to be visible, neighbours are merged under the name that takes the most time among
/// them, which leaves about `max_spans` (≥ 1) spans over all rows, at worst twice as many. Thread
/// rule: pure.
std::vector<TimelineRow> timeline_of(const scheduler::TraceData& trace, int max_spans = 2000);

}  // namespace vantage
