#include "scheduler/tbb_node_executor.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "scheduler/shared_loop.h"
#include "scheduler/tbb_node_arena.h"
#include "scheduler/tbb_node_frames.h"

namespace vantage::scheduler {
namespace {

void for_each_index(int count, const std::function<void(int)>& body) {
  tbb::parallel_for(
      tbb::blocked_range<int>(0, count, 1),
      [&](const tbb::blocked_range<int>& range) {
        for (int index = range.begin(); index != range.end(); ++index) {
          body(index);
        }
      },
      tbb::simple_partitioner());
}

class TbbNodeExecutor final : public Executor {
 public:
  explicit TbbNodeExecutor(const ThreadPlaces& places)
      : thread_count_(places.thread_count()),
        threads_of_nodes_(places.threads_of_nodes()),
        callers_work_(threads_of_nodes_.front() > 1) {
    const int needed = thread_count_ + (callers_work_ ? 0 : 1);
    if (needed > tbb::info::default_concurrency()) {  // see TbbExecutor
      limit_.emplace(tbb::global_control::max_allowed_parallelism,
                     static_cast<std::size_t>(needed));
    }
    for (int node = 0; node < static_cast<int>(places.nodes.size()); ++node) {
      nodes_.push_back(
          std::make_unique<NodeArena>(node, places, node == 0 && callers_work_ ? 1 : 0));
    }
  }

  /// Tasks that came too late for their loops are waited for: what they hold would otherwise still
  /// be there when the program ends.
  ~TbbNodeExecutor() override {
    for (int left = left_tasks_->load(); left != 0; left = left_tasks_->load()) {
      left_tasks_->wait(left);
    }
  }
  TbbNodeExecutor(const TbbNodeExecutor&) = delete;
  TbbNodeExecutor& operator=(const TbbNodeExecutor&) = delete;

  [[nodiscard]] std::string_view name() const override { return "tbb"; }
  [[nodiscard]] int thread_count() const override { return thread_count_; }

  void parallel_for(int task_count, const std::function<void(int)>& body) override {
    const NodeVisit* visit = visit_of_this_thread();
    if (visit != nullptr && (visit->loops_stay() || nodes_.size() == 1)) {
      const NodeArena& here = visit->arena();
      const bool stay = visit->loops_stay();
      for_each_index(task_count, [&](int task) {
        const NodeVisit inside(here, stay);
        body(task);
      });
    } else {
      share(task_count, body, visit);
    }
  }

  void run_frame_steps(int in_flight, const FrameSteps& steps) override {
    run_frames_on_nodes(nodes_, callers_work_, in_flight, steps);
  }

 private:
  /// The calling thread's visit of one of these nodes; null when it comes from outside.
  [[nodiscard]] const NodeVisit* visit_of_this_thread() const {
    const NodeVisit* visit = NodeVisit::innermost();
    const bool is_here =
        visit != nullptr && std::ranges::any_of(nodes_, [&](const std::unique_ptr<NodeArena>& one) {
          return one.get() == &visit->arena();
        });
    return is_here ? visit : nullptr;
  }

  /// A loop of all nodes. Each is left one task in TBB's sense, which calls the node's threads.
  void share(int task_count, const std::function<void(int)>& body, const NodeVisit* visit) {
    if (task_count == 0) {
      return;
    }
    const auto loop = std::make_shared<SharedLoop>(task_count, threads_of_nodes_, body);
    const NodeArena& here = visit == nullptr ? *nodes_.front() : visit->arena();
    const auto work_on = [loop, task_count](const NodeArena& node, int index, int threads) {
      for_each_index(std::min(threads, task_count), [&](int) { help(*loop, node, index); });
    };
    const auto leave_to = [&](NodeArena& node) {
      left_tasks_->fetch_add(1);
      // The counter outlives the executor, which may go as soon as it is 0.
      node.arena().enqueue([work_on, &node, left_tasks = left_tasks_] {
        work_on(node, node.node(), node.thread_count());
        left_tasks->fetch_sub(1);
        left_tasks->notify_all();
      });
    };
    for (const std::unique_ptr<NodeArena>& node : nodes_) {
      if (node.get() != &here) {
        leave_to(*node);
      }
    }
    if (visit != nullptr) {
      work_on(here, here.node(), here.thread_count());
    } else if (callers_work_) {
      nodes_.front()->arena().execute([&] { work_on(here, here.node(), here.thread_count()); });
    } else {
      leave_to(*nodes_.front());
    }
    loop->wait();
  }

  /// Runs tasks of `loop` while there are any. May be called when the loop has ended.
  static void help(SharedLoop& loop, const NodeArena& node, int index) {
    std::optional<int> task = loop.take(index);
    if (!task) {
      return;
    }
    const NodeVisit inside(node, false);
    for (; task; task = loop.take(index)) {
      loop.run(*task);
    }
  }

  int thread_count_;
  std::vector<int> threads_of_nodes_;
  // Callers from outside are one of the first node's threads. Where that has but one they sleep
  // instead: TBB sends a worker to any arena that tasks are left in, which would be one too many.
  bool callers_work_;
  std::optional<tbb::global_control> limit_;
  std::vector<std::unique_ptr<NodeArena>> nodes_;
  /// That were left in arenas and have not ended.
  std::shared_ptr<std::atomic<int>> left_tasks_ = std::make_shared<std::atomic<int>>(0);
};

}  // namespace

std::unique_ptr<Executor> make_tbb_node_executor(const ThreadPlaces& places) {
  return std::make_unique<TbbNodeExecutor>(places);
}

}  // namespace vantage::scheduler
