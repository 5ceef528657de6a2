#include "scheduler/openmp_executor.h"

#include <omp.h>

#include <atomic>
#include <exception>
#include <optional>
#include <vector>

#include "scheduler/bound_thread.h"
#include "scheduler/task_ranges.h"

namespace vantage::scheduler {
namespace {

/// Keeps the first exception of a loop: none may leave an OpenMP region.
class FirstError {
 public:
  [[nodiscard]] bool failed() const { return failed_.load(std::memory_order_relaxed); }

  void run(const std::function<void(int)>& body, int task) {
    if (failed()) {
      return;
    }
    try {
      body(task);
    } catch (...) {
      if (!failed_.exchange(true)) {
        error_ = std::current_exception();
      }
    }
  }

  void rethrow() const {
    if (error_) {
      std::rethrow_exception(error_);
    }
  }

 private:
  std::atomic<bool> failed_{false};
  std::exception_ptr error_;
};

class OpenMpExecutor final : public Executor {
 public:
  explicit OpenMpExecutor(const ThreadPlaces& places)
      : threads_(places.thread_count()),
        threads_of_nodes_(places.threads_of_nodes()),
        system_(places.system) {
    for (int node = 0; node < static_cast<int>(places.nodes.size()); ++node) {
      for (const std::vector<int>& allowed : places.nodes[static_cast<std::size_t>(node)].allowed) {
        members_.push_back({node, allowed});
      }
    }
  }

  [[nodiscard]] std::string_view name() const override { return "openmp"; }
  [[nodiscard]] int thread_count() const override { return threads_; }

  void parallel_for(int task_count, const std::function<void(int)>& body) override {
    FirstError error;
    if (omp_in_parallel() != 0) {
      // Inside a frame step: the strips become tasks of the team that runs the frames.
#pragma omp taskloop grainsize(1) default(none) shared(error, body, task_count)
      for (int task = 0; task < task_count; ++task) {
        error.run(body, task);
      }
    } else {
      TaskRanges tasks(task_count, threads_of_nodes_);
#pragma omp parallel num_threads(threads_) default(none) shared(error, body, tasks)
      {
        const Member& member = this_member();
        const BoundThread bound(system_, member.allowed);
        while (const std::optional<int> task = tasks.take(member.node)) {
          error.run(body, *task);
        }
      }
    }
    error.rethrow();
  }

  void run_frame_steps(int in_flight, const FrameSteps& steps) override {
    // Tasks are ordered through the addresses they name as dependences: `slots[s]` chains the
    // steps and frames of a slot, `orders[…]` the frames whose computation is in order, `writer`
    // the deliveries. Reading stays on the thread that creates the tasks, which first waits for the
    // slot's previous frame.
    std::vector<char> slots(static_cast<std::size_t>(in_flight));
    std::vector<char> orders(static_cast<std::size_t>(in_flight));
    [[maybe_unused]] char* slot_token = slots.data();
    [[maybe_unused]] char* order_token = orders.data();
    [[maybe_unused]] char writer = 0;
#pragma omp parallel num_threads(threads_) default(none) \
    shared(steps, slot_token, order_token, writer, in_flight)
    {
      const BoundThread bound(system_, this_member().allowed);
#pragma omp single
      for (int slot = 0;; slot = (slot + 1) % in_flight) {
#pragma omp taskwait depend(inout : slot_token[slot])
        if (!steps.read(slot)) {
          break;
        }
#pragma omp task default(none) shared(steps, slot_token) firstprivate(slot) \
    depend(inout                                                            \
           : slot_token[slot])
        steps.prepare(slot);
        [[maybe_unused]] const int order = steps.compute_in_order ? 0 : slot;
#pragma omp task default(none) shared(steps, slot_token, order_token) firstprivate(slot) \
    depend(inout                                                                         \
           : slot_token[slot]) depend(inout                                              \
                                      : order_token[order])
        steps.compute(slot);
#pragma omp task default(none) shared(steps, slot_token) firstprivate(slot) \
    depend(inout                                                            \
           : slot_token[slot])
        steps.encode(slot);
#pragma omp task default(none) shared(steps, slot_token, writer) firstprivate(slot) \
    depend(inout                                                                    \
           : slot_token[slot]) depend(inout                                         \
                                      : writer)
        steps.write(slot);
      }
    }
  }

 private:
  /// What the place of a team's thread is.
  struct Member {
    int node;
    std::vector<int> allowed;
  };

  /// In a region. The system may have given the team fewer threads, never more.
  [[nodiscard]] const Member& this_member() const {
    return members_[static_cast<std::size_t>(omp_get_thread_num())];
  }

  int threads_;
  std::vector<int> threads_of_nodes_;
  std::shared_ptr<hwloc_topology> system_;
  std::vector<Member> members_;
};

}  // namespace

std::unique_ptr<Executor> make_openmp_executor(const ThreadPlaces& places) {
  return std::make_unique<OpenMpExecutor>(places);
}

}  // namespace vantage::scheduler
