#pragma once

#include <vector>

#include "engine/profiling/profile.h"
#include "scheduler/trace.h"

namespace vantage {

/// What the threads of a trace, whose waits have been added, did; a row for each. Where pieces are
/// too short to be seen, neighbours are joined under the name of whichever takes the most time of
/// them, so that there are about `most_spans` (≥ 1) at most over all rows, and twice as many at the
/// very worst. Thread rule: pure.
std::vector<TimelineRow> timeline_of(const scheduler::TraceData& trace, int most_spans = 2000);

}  // namespace vantage
