#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "scheduler/executor.h"
#include "scheduler/machine.h"
#include "scheduler/scratch_pool.h"

namespace vantage {

/// How work is spread over the machine. Nothing here changes a result.
struct ExecutionOptions {
  std::optional<int> threads =
      std::nullopt;  ///< 1..1024; default: the hardware threads this process may use
  scheduler::ExecutorKind executor = scheduler::ExecutorKind::kTbb;
  /// Default: on nodes where the threads need more than one, else anywhere.
  std::optional<scheduler::ThreadBinding> binding = std::nullopt;
  std::optional<int> strip_width_px = std::nullopt;  ///< ≥ 1; default from the cost model
  std::optional<int> band_height_px = std::nullopt;  ///< ≥ 1; default from the cost model
  /// Iterations between two stores of the whole state, ≥ 1; default from the cost model.
  std::optional<int> iterations_per_pass = std::nullopt;

  /// For what the iterations of one map store between passes, with the scratch of all threads; as
  /// far as it can be kept. Default scheduler::kDefaultMemoryBytes.
  std::optional<std::size_t> chain_memory_bytes = std::nullopt;

  /// Throws UsageError naming the field, its value and its limit.
  void validate() const;
};

/// How many threads an Execution with `options` has on `machine`.
int thread_count(const ExecutionOptions& options, const scheduler::Machine& machine);

/// The threads, the scratch memory and the knowledge of the machine that matchers and synthesisers
/// share. Thread rule: may be used by several frames at once. Outlives everything that uses it.
class Execution {
 public:
  explicit Execution(const ExecutionOptions& options);

  [[nodiscard]] const ExecutionOptions& options() const { return options_; }
  [[nodiscard]] const scheduler::Machine& machine() const { return machine_; }
  [[nodiscard]] scheduler::Executor& executor() { return *executor_; }
  [[nodiscard]] scheduler::ScratchPool& scratch() { return scratch_; }

  /// Calls body(first_row, end_row) for bands that cover [0, rows) exactly, in parallel. For row
  /// work without cells (refinement, warping); the bands do not depend on the thread count.
  void for_each_band(int rows, const std::function<void(int first_row, int end_row)>& body);

 private:
  ExecutionOptions options_;
  scheduler::Machine machine_;
  std::unique_ptr<scheduler::Executor> executor_;
  scheduler::ScratchPool scratch_;
};

}  // namespace vantage
