#include "engine/options/execution_settings.h"

#include <fmt/format.h>

namespace vantage {

void add_execution_settings(Settings& settings, ExecutionOptions& execution, Work work) {
  using scheduler::ExecutorKind;
  using scheduler::ThreadBinding;
  settings.start_group("Execution (never changes a result)", false);
  settings.integer("threads", execution.threads, "N",
                   fmt::format("Threads, up to {} a processor; auto: all that this process may use",
                               kMaxThreadsPerProcessor));
  settings.choice<ExecutorKind>("executor", execution.executor,
                                {{"tbb", ExecutorKind::kTbb},
                                 {"openmp", ExecutorKind::kOpenMp},
                                 {"serial", ExecutorKind::kSerial}},
                                "Threading library");
  settings.choice<ThreadBinding>("bind", execution.binding,
                                 {{"none", ThreadBinding::kNone},
                                  {"node", ThreadBinding::kNodes},
                                  {"core", ThreadBinding::kCores}},
                                 "Bind each thread to one NUMA node or to one core; auto: to nodes "
                                 "if one node has too few cores for all threads");
  if (work == Work::kWithMatching) {
    settings.integer("strip-width", execution.strip_width_px, "PX",
                     "Columns per strip; auto: from the cache sizes");
    settings.integer("band-height", execution.band_height_px, "PX",
                     "Rows per band; auto: from the cache sizes");
    settings.integer("iterations-per-pass", execution.iterations_per_pass, "K",
                     "Iterations per pass over memory; auto: from the cache sizes");
  }
}

}  // namespace vantage
