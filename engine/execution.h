#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "scheduler/executor.h"
#include "scheduler/machine.h"
#include "scheduler/scratch_pool.h"
#include "scheduler/shared_threads.h"

namespace vantage {

/// How work is distributed over the machine. Results do not depend on it.
struct ExecutionOptions {
  /// 1..1024, see thread_count(); default: the hardware threads available to this process.
  std::optional<int> threads = std::nullopt;
  scheduler::ExecutorKind executor = scheduler::ExecutorKind::kTbb;
  /// Default: bind to nodes where the threads need more than one, else no binding.
  std::optional<scheduler::ThreadBinding> binding = std::nullopt;
  std::optional<int> strip_width_px = std::nullopt;  ///< ≥ 1; default from the cost model
  std::optional<int> band_height_px = std::nullopt;  ///< ≥ 1; default from the cost model
  /// Iterations between two stores of the whole state, ≥ 1; default from the cost model.
  std::optional<int> iterations_per_pass = std::nullopt;

  /// Memory budget for what the iterations of one map store between passes plus the scratch of all
  /// threads; a target, not a hard limit. Default scheduler::kDefaultMemoryBytes.
  std::optional<std::size_t> chain_memory_bytes = std::nullopt;

  /// Coarse levels of a map whose costs take more are made in bands of rows, which takes longer.
  /// Default kDefaultLevelBytes.
  std::optional<std::size_t> level_memory_bytes = std::nullopt;

  /// Throws UsageError naming the field, its value and its limit.
  void validate() const;
};

/// More threads than that for each processor only look for work: an Execution has no more.
inline constexpr int kMaxThreadsPerProcessor = 16;

/// Number of threads of an Execution with `options` on `machine`.
int thread_count(const ExecutionOptions& options, const scheduler::Machine& machine);

/// Threads, scratch memory and machine properties that matchers and synthesisers share. Must
/// outlive everything that uses it. Thread rule: several threads may use it at once. Their loops
/// share its threads. Callers that hold a scheduler::SharedThreads::Call are counted among these
/// threads, between loops as well. A scheduler::InterruptibleScope ends its loops early.
class Execution {
 public:
  /// Throws UsageError for invalid options.
  explicit Execution(const ExecutionOptions& options);

  [[nodiscard]] const ExecutionOptions& options() const { return options_; }
  [[nodiscard]] const scheduler::Machine& machine() const { return machine_; }
  [[nodiscard]] scheduler::Executor& executor() { return *executor_; }
  [[nodiscard]] scheduler::ScratchPool& scratch() { return scratch_; }
  /// For calls of several threads: none works without one of the execution's threads.
  [[nodiscard]] scheduler::SharedThreads& threads() { return *threads_; }

  /// Calls body(first_row, end_row) in parallel for bands that cover [0, rows) exactly. For row
  /// work without cells (refinement, warping). Bands do not depend on the number of threads.
  void for_each_band(int rows, const std::function<void(int first_row, int end_row)>& body);
  /// Calls body(row) for each row, in the bands of for_each_band().
  template <typename Body>
  void for_each_row(int rows, const Body& body) {
    for_each_band(rows, [&](int first_row, int end_row) {
      for (int row = first_row; row < end_row; ++row) {
        body(row);
      }
    });
  }

 private:
  ExecutionOptions options_;
  scheduler::Machine machine_;
  std::unique_ptr<scheduler::SharedThreads> threads_;
  std::unique_ptr<scheduler::Executor> executor_;
  scheduler::ScratchPool scratch_;
};

/// The default execution: one for the whole process, with default options, made at
/// the first call and kept until the process ends. Thread rule: any thread.
Execution& default_execution();

}  // namespace vantage
