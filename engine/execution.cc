#include "engine/execution.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/error.h"
#include "engine/thread_placement.h"
#include "scheduler/interruption.h"

namespace vantage {
namespace {

// Rows per task of for_each_band(): enough to hide the cost of a task, few enough to balance.
constexpr int kBandRows = 16;

void require_positive(const char* field, const std::optional<int>& value) {
  if (value && *value < 1) {
    throw UsageError(fmt::format("{} is {}, expected at least 1", field, *value));
  }
}

}  // namespace

void ExecutionOptions::validate() const {
  require_positive("threads", threads);
  require_positive("strip-width", strip_width_px);
  require_positive("band-height", band_height_px);
  require_positive("iterations-per-pass", iterations_per_pass);
  if (threads && *threads > 1024) {
    throw UsageError(fmt::format("threads is {}, expected at most 1024", *threads));
  }
  if (executor == scheduler::ExecutorKind::kSerial && binding &&
      *binding != scheduler::ThreadBinding::kNone) {
    throw UsageError(fmt::format(
        "bind is {}, expected auto or none: the serial executor has no threads of its own",
        name_of(*binding)));
  }
}

int thread_count(const ExecutionOptions& options, const scheduler::Machine& machine) {
  if (options.executor == scheduler::ExecutorKind::kSerial) {
    return 1;
  }
  return std::min(options.threads.value_or(machine.hardware_threads),
                  kMaxThreadsPerProcessor * machine.hardware_threads);
}

Execution::Execution(const ExecutionOptions& options) : options_(options) {
  options_.executor = scheduler::built_in_executor(options_.executor);
  options_.validate();
  const scheduler::Topology topology = scheduler::detect_topology();
  machine_ = topology.machine;
  auto executor = scheduler::make_executor(options_.executor, thread_places(options_, topology));
  threads_ = std::make_unique<scheduler::SharedThreads>(executor->thread_count());
  executor_ = scheduler::interruptible(scheduler::sharing(std::move(executor), *threads_));
}

void Execution::for_each_band(int rows,
                              const std::function<void(int first_row, int end_row)>& body) {
  executor_->parallel_for((rows + kBandRows - 1) / kBandRows, [&](int band) {
    body(band * kBandRows, std::min((band + 1) * kBandRows, rows));
  });
}

Execution& default_execution() {
  // Never freed: other threads may use it until the process ends.
  static auto* const execution = new Execution(ExecutionOptions{});
  return *execution;
}

}  // namespace vantage
