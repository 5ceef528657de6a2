#include "apps/submit/planned_requests.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "apps/batch/batch_item.h"
#include "apps/batch/batch_plan.h"
#include "apps/batch/batch_report.h"
#include "apps/batch/manifest.h"
#include "engine/error.h"

namespace vantage::apps {
namespace {

constexpr int kUsualCores = 4;
constexpr int kMaxUsualTasks = 1000;

// Estimates are not exact: a limit should stop what hangs, not what is slow.
constexpr double kTimeFactor = 4;
constexpr long kMinTime_s = 3600;
constexpr double kMemoryFactor = 1.25;
constexpr std::size_t kProgramBytes = std::size_t{256} << 20;

BatchPlan plan_of(const SubmitJob& job, const Settings& settings) {
  const std::vector<ManifestItem> items = read_manifest(job.batch.manifest);
  BatchPlan plan = make_plan(job.batch, items, options_of_all(settings), [](int) {});
  if (!job.batch.run.common.quiet) {
    fmt::print("{}", describe_plan(plan, job.batch, items.size()));
  }
  return plan;
}

std::size_t memory_of(const BatchPlan& plan) {
  std::size_t bytes = 0;
  for (const PlannedJob& planned : plan.jobs) {
    bytes = std::max(bytes, planned.memory_bytes);
  }
  return kProgramBytes + static_cast<std::size_t>(kMemoryFactor * static_cast<double>(bytes));
}

/// For the task with the most work: task k does the jobs k, k + tasks and so on.
long time_of(const BatchPlan& plan, const ArrayJob& array) {
  std::vector<double> core_seconds(static_cast<std::size_t>(array.tasks));
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    core_seconds[i % core_seconds.size()] += plan.jobs[i].core_seconds;
  }
  const double seconds = std::ranges::max(core_seconds) / *array.cores;
  return std::max(kMinTime_s, static_cast<long>(kTimeFactor * seconds));
}

}  // namespace

void plan_requests(SubmitJob& job, const Settings& settings, ArrayJob& array) {
  std::optional<int>& threads = job.batch.run.common.execution.threads;
  if (!array.cores) {
    array.cores = threads.value_or(kUsualCores);
  }
  threads = array.cores;
  const bool is_local = job.options.engine == BatchEngine::kLocal;
  if (array.memory_bytes && (job.options.tasks || is_local)) {
    array.tasks = job.options.tasks.value_or(kMaxUsualTasks);
    return;
  }
  const BatchPlan plan = plan_of(job, settings);
  array.tasks =
      job.options.tasks.value_or(std::clamp(static_cast<int>(plan.jobs.size()), 1, kMaxUsualTasks));
  if (!array.memory_bytes) {
    array.memory_bytes = memory_of(plan);
  }
  if (!array.time_limit_s && !is_local) {
    array.time_limit_s = time_of(plan, array);
  }
}

}  // namespace vantage::apps
