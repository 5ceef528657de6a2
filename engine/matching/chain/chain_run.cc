#include "engine/matching/chain/chain_run.h"

#include <algorithm>
#include <vector>

#include "scheduler/range.h"
#include "scheduler/strip_pipeline.h"

namespace vantage {
namespace {

/// `rows` of the last stage, in strips about as wide as those of `plan`, but in one pass.
std::vector<scheduler::Region> strips_of(scheduler::Chain chain, scheduler::Range rows,
                                         const scheduler::ChainPlan& plan) {
  int reach = 0;
  for (const scheduler::RowReach& of_stage : scheduler::row_reaches(chain)) {
    reach += of_stage.below;
  }
  constexpr int kColumnsPerReach = 12;  // columns of both halos are a sixth
  int columns = kColumnsPerReach * reach;
  for (const scheduler::PassPlan& pass : plan.passes) {
    columns = std::max(columns, pass.strip_columns);
  }
  std::vector<scheduler::Region> strips;
  const int width = chain.back()->extent().columns;
  for (int x = 0; x < width; x += columns) {
    strips.push_back({{x, std::min(x + columns, width)}, rows});
  }
  return strips;
}

}  // namespace

scheduler::ChainPlan chain_plan(const MatchChain& chain, const ExecutionOptions& execution,
                                int threads, const scheduler::Machine& machine) {
  scheduler::PlanRequest request;
  request.threads = threads;
  request.strip_columns = execution.strip_width_px;
  request.band_rows = execution.band_height_px;
  request.memory_bytes = execution.chain_memory_bytes;
  if (execution.iterations_per_pass) {
    request.pass_ends = chain.pass_ends(*execution.iterations_per_pass);
  }
  return scheduler::plan_chain(chain.stages(), machine, request);
}

void run_chain(const MatchChain& chain, Execution& execution, scheduler::ChainPlan& plan) {
  if (chain.regions() != nullptr) {
    scheduler::run_regions(chain.stages(), *chain.regions(), execution.executor(),
                           execution.scratch());
    return;
  }
  plan = chain_plan(chain, execution.options(), execution.executor().thread_count(),
                    execution.machine());
  if (chain.rows()) {
    scheduler::run_regions(chain.stages(), strips_of(chain.stages(), *chain.rows(), plan),
                           execution.executor(), execution.scratch());
    return;
  }
  scheduler::run_strips(chain.stages(), plan, execution.executor(), execution.scratch());
}

}  // namespace vantage
