#pragma once

#include "engine/execution.h"
#include "engine/matching/chain/match_chain.h"
#include "scheduler/strip_plan.h"

namespace vantage {

/// Execution plan of a chain on `threads` threads.
scheduler::ChainPlan chain_plan(const MatchChain& chain, const ExecutionOptions& execution,
                                int threads, const scheduler::Machine& machine);

/// Computes a chain's outputs, or the regions or rows of them that it is asked for. `plan`: the
/// chain's; left as it is if there are regions, which have none.
void run_chain(const MatchChain& chain, Execution& execution, scheduler::ChainPlan& plan);

}  // namespace vantage
