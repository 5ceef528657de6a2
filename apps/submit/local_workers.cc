#include "apps/submit/local_workers.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <future>

#include "apps/process/child_process.h"
#include "apps/process/interrupt.h"
#include "apps/process/tell.h"
#include "apps/submit/engine_table.h"
#include "scheduler/control_groups.h"
#include "scheduler/machine.h"

namespace vantage::apps {
namespace {

/// Exit code of a worker that prints to its log. It keeps the pipe of run_program(), which looks at
/// `stop` for as long as that is open.
int run_worker(const std::vector<std::string>& command, const std::filesystem::path& log,
               const std::atomic<bool>& stop) {
  std::vector<std::string> logged = {"/bin/sh", "-c", R"(exec 3>&1; exec "$@" >>"$0" 2>&1)",
                                     log.string()};
  logged.insert(logged.end(), command.begin(), command.end());
  const int code = run_program(logged, &stop).exit_code;
  if (code != 0) {
    tell("submit: a worker ended with exit code {}; see {}\n", code, log.string());
  }
  return code;
}

}  // namespace

int workers_that_fit(int cores, std::size_t memory_bytes, std::optional<int> limit) {
  const int of_cores = scheduler::detect_machine().hardware_threads / cores;
  const std::size_t free_bytes = scheduler::read_system_limits().free_bytes;
  const int of_memory =
      free_bytes == 0 ? of_cores
                      : static_cast<int>(std::min<std::size_t>(free_bytes / memory_bytes, 1024));
  return std::max(1, std::min({of_cores, of_memory, limit.value_or(of_cores)}));
}

int run_workers(const ArrayJob& job, const std::vector<std::vector<std::string>>& commands) {
  const std::atomic<bool>& stop = interrupt_flag();
  std::vector<std::future<int>> workers;
  for (const std::vector<std::string>& command : commands) {
    const auto log = job.folder / fmt::format("worker-{}.log", workers.size() + 1);
    workers.push_back(
        std::async(std::launch::async, [&, log] { return run_worker(command, log, stop); }));
  }
  int code = 0;
  for (std::future<int>& worker : workers) {
    code = std::max(code, worker.get());
  }
  return code;
}

Submission local_submission(const ArrayJob& job, const SubmitOptions& /*options*/) {
  return {.files = {}, .commands = std::vector(static_cast<std::size_t>(job.tasks), job.command)};
}

}  // namespace vantage::apps
