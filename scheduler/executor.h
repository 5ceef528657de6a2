#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

namespace vantage::scheduler {

/// The five steps of one frame in a sequence. `slot` is a number in [0, in_flight); no two frames
/// in flight at the same time have the same slot, so buffers can be kept per slot.
struct FrameSteps {
  /// Fetches the next frame into `slot`; false at the end. Called in order, never concurrently.
  std::function<bool(int slot)> read;
  /// Converts what was read into `slot` to what compute() needs. Called concurrently for different
  /// slots.
  std::function<void(int slot)> prepare;
  /// Computes the frame in `slot`. Called concurrently for different slots, unless
  /// compute_in_order: then in the order of reading, never concurrently.
  std::function<void(int slot)> compute;
  /// Encodes the results in `slot` into what write() delivers. Called concurrently for different
  /// slots.
  std::function<void(int slot)> encode;
  /// Delivers the frame in `slot`. Called in the order of reading, never concurrently.
  std::function<void(int slot)> write;
  /// Set if a frame needs results of the frame before it.
  bool compute_in_order = false;
};

/// A pool of threads and the two ways this project uses one: loops over independent tasks, and
/// ordered pipelines of frames whose steps may themselves run such loops in the same pool.
///
/// Thread rule: parallel_for() may be called from any thread, also from inside a running task or
/// frame step. Errors: the first exception thrown by a task is rethrown to the caller after all
/// running tasks have ended; tasks that have not started by then are dropped.
class Executor {
 public:
  Executor() = default;
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;
  virtual ~Executor() = default;

  [[nodiscard]] virtual std::string_view name() const = 0;
  [[nodiscard]] virtual int thread_count() const = 0;

  /// Calls body(task) once for each task in [0, task_count), in no particular order.
  virtual void parallel_for(int task_count, const std::function<void(int task)>& body) = 0;

  /// Runs frames through `steps` with at most `in_flight` (≥ 1) of them at a time.
  /// Steps must not throw: run_frames() of frame_pipeline.h wraps steps that do.
  virtual void run_frame_steps(int in_flight, const FrameSteps& steps) = 0;
};

enum class ExecutorKind { kTbb, kOpenMp, kSerial };

/// Where threads may run.
enum class ThreadBinding : std::uint8_t {
  kNone,   ///< wherever the system puts them
  kNodes,  ///< each on the cores of one NUMA node
  kCores   ///< each on a core of its own
};

/// Thread counts are ≥ 1. The executor owns its threads.
std::unique_ptr<Executor> make_executor(ExecutorKind kind, int threads,
                                        ThreadBinding binding = ThreadBinding::kNone);

/// For tests: one thread, tasks in an order drawn from `seed`.
std::unique_ptr<Executor> make_shuffled_executor(std::uint64_t seed);

}  // namespace vantage::scheduler
