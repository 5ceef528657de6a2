#include "scheduler/tbb_executor.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include <oneapi/tbb/version.h>
#include <optional>

namespace vantage::scheduler {
namespace {

class TbbExecutor final : public Executor {
 public:
  explicit TbbExecutor(int threads) : arena_(threads) {
    // TBB runs no more threads than the machine has unless this raises the limit: tests and tuning
    // ask for more. (It must not lower it: executors of several sizes live side by side.)
    if (threads > tbb::info::default_concurrency()) {
      limit_.emplace(tbb::global_control::max_allowed_parallelism,
                     static_cast<std::size_t>(threads));
    }
  }

  [[nodiscard]] std::string_view name() const override { return "tbb"; }
  [[nodiscard]] int thread_count() const override { return arena_.max_concurrency(); }

  void parallel_for(int task_count, const std::function<void(int)>& body) override {
    // One task per index: a task is a strip of a frame, long enough to be stolen alone. A thread
    // that waits here may take work of another frame: no task waits while it holds scratch.
    arena_.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<int>(0, task_count, 1),
          [&](const tbb::blocked_range<int>& tasks) {
            for (int task = tasks.begin(); task != tasks.end(); ++task) {
              body(task);
            }
          },
          tbb::simple_partitioner());
    });
  }

  void run_frame_steps(int in_flight, const FrameSteps& steps) override {
    // The pipeline has at most `in_flight` tokens and its last filter is in order, so frame
    // i − in_flight has been written before frame i is read: slots are free when reused.
    const tbb::filter_mode compute_mode =
        steps.compute_in_order ? tbb::filter_mode::serial_in_order : tbb::filter_mode::parallel;
    int next_slot = 0;
    const auto read = [&](tbb::flow_control& control) {
      const int slot = next_slot;
      if (steps.read(slot)) {
        next_slot = (slot + 1) % in_flight;
      } else {
        control.stop();
      }
      return slot;
    };
    const auto filter = [](tbb::filter_mode mode, const std::function<void(int)>& step) {
      return tbb::make_filter<int, int>(mode, [&step](int slot) {
        step(slot);
        return slot;
      });
    };
    arena_.execute([&] {
      tbb::parallel_pipeline(
          static_cast<std::size_t>(in_flight),
          tbb::make_filter<void, int>(tbb::filter_mode::serial_in_order, read) &
              filter(tbb::filter_mode::parallel, steps.prepare) &
              filter(compute_mode, steps.compute) &
              filter(tbb::filter_mode::parallel, steps.encode) &
              tbb::make_filter<int, void>(tbb::filter_mode::serial_in_order, steps.write));
    });
  }

 private:
  std::optional<tbb::global_control> limit_;
  tbb::task_arena arena_;
};

}  // namespace

std::unique_ptr<Executor> make_tbb_executor(int threads) {
  return std::make_unique<TbbExecutor>(threads);
}

std::string tbb_version() { return TBB_runtime_version(); }

}  // namespace vantage::scheduler
