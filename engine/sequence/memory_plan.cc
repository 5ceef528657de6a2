#include "engine/sequence/memory_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/error.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/sequence/steps/step_list.h"
#include "scheduler/control_groups.h"

namespace vantage {
namespace {

constexpr int kDefaultMaxInFlight = 34;  // more only even out unequal frames
/// The program, its libraries and their one-time initialisation.
constexpr std::size_t kProcessBytes = std::size_t{84} << 20;
/// Per thread: stack, allocator arena.
constexpr std::size_t kThreadBytes = std::size_t{3} << 20;

/// Of all steps, at once.
StepBytes bytes_of_steps(const SequenceOptions& options, const PairShape& shape) {
  StepBytes all;
  for (const StepEntry& step : frame_steps()) {
    if (step.planned_bytes != nullptr) {
      const StepBytes bytes = step.planned_bytes(options, shape);
      all.of_frame += bytes.of_frame;
      all.of_work += bytes.of_work;
      all.of_run += bytes.of_run;
    }
  }
  return all;
}

/// Plan of one map.
scheduler::ChainPlan chain_of(const SequenceOptions& options, const FramePair& first,
                              Execution& execution) {
  const StereoMatcher matcher(options.match, execution);
  if (options.baselines.empty()) {
    return matcher.plan(first.left, first.right);
  }
  std::vector<OtherView> others = {{&first.right, options.baselines.front()}};
  for (std::size_t k = 0; k < first.more.size(); ++k) {
    others.push_back({&first.more[k], options.baselines[k + 1]});
  }
  return matcher.plan_several(first.left, others);
}

}  // namespace

int default_frames_in_flight(int threads) { return std::min(threads + 2, kDefaultMaxInFlight); }

MemoryRequest memory_request(std::optional<int> in_flight,
                             std::optional<std::size_t> memory_bytes) {
  MemoryRequest request{.in_flight = in_flight, .memory_bytes = memory_bytes};
  if (!memory_bytes) {
    request.free_bytes = scheduler::read_system_limits().free_bytes;
    if (request.free_bytes > 0) {
      request.memory_bytes = request.free_bytes / 5 * 4;
    }
  }
  return request;
}

MemoryPlan plan_memory(const SequenceOptions& options, const MemoryRequest& request,
                       const PairShape& shape, const FramePair& first,
                       const ExecutionOptions& execution) {
  ExecutionOptions limited = execution;
  MemoryPlan plan;
  const StepBytes steps = bytes_of_steps(options, shape);
  plan.frame_bytes = steps.of_frame;
  int threads = 1;
  {
    Execution probe(execution);
    threads = probe.executor().thread_count();
  }
  const std::size_t fixed =
      kProcessBytes + steps.of_run + static_cast<std::size_t>(threads) * kThreadBytes;
  const int wanted = request.in_flight.value_or(default_frames_in_flight(threads));
  for (plan.in_flight = std::min(wanted, kMaxFramesInFlight); plan.in_flight >= 1;
       --plan.in_flight) {
    const auto matched = static_cast<std::size_t>(std::min(plan.in_flight, threads));
    const std::size_t frames =
        static_cast<std::size_t>(plan.in_flight) * plan.frame_bytes + matched * steps.of_work;
    plan.chain_bytes = scheduler::kDefaultMemoryBytes;
    if (request.memory_bytes) {
      const std::size_t limit = *request.memory_bytes;
      if (limit <= fixed + frames && plan.in_flight > 1) {
        continue;
      }
      const std::size_t rest = limit > fixed + frames ? limit - fixed - frames : 1;
      plan.chain_bytes = std::min(plan.chain_bytes, std::max<std::size_t>(1, rest / matched));
    }
    limited.chain_memory_bytes = plan.chain_bytes;
    Execution probe(limited);
    plan.chain = chain_of(options, first, probe);
    std::size_t scratch = 0;
    for (const scheduler::PassPlan& pass : plan.chain.passes) {
      scratch = std::max(scratch, pass.scratch_bytes);
    }
    plan.total_bytes = fixed + frames + static_cast<std::size_t>(threads) * scratch +
                       matched * plan.chain.stored_bytes;
    if (request.allows(plan) || (request.free_bytes > 0 && plan.in_flight == 1)) {
      return plan;
    }
  }
  throw Error(fmt::format("memory is {} MiB, expected at least {} MiB for one frame of {}x{}",
                          *request.memory_bytes >> 20, (plan.total_bytes >> 20) + 1,
                          shape.source.width_px, shape.source.height_px));
}

}  // namespace vantage
