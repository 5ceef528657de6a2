#include "scheduler/tbb_node_frames.h"

#include <oneapi/tbb/spin_mutex.h>
#include <oneapi/tbb/task_group.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <optional>
#include <utility>

namespace vantage::scheduler {
namespace {

/// Lets slots pass one at a time in the order 0, 1, …, last, 0, … of the frames in them.
class Turnstile {
 public:
  explicit Turnstile(int slots) : waiting_(static_cast<std::size_t>(slots)) {}

  /// True if `slot` may pass now; else leave() of the one before it will say so.
  bool arrive(int slot) {
    const tbb::spin_mutex::scoped_lock lock(mutex_);
    const bool passes = slot == next_ && !occupied_;
    occupied_ = occupied_ || passes;
    waiting_[static_cast<std::size_t>(slot)] = !passes;
    return passes;
  }
  /// To be called by the slot that has passed; the one that may pass now, if it has arrived.
  std::optional<int> leave() {
    const tbb::spin_mutex::scoped_lock lock(mutex_);
    next_ = (next_ + 1) % static_cast<int>(waiting_.size());
    const auto next = static_cast<std::size_t>(next_);
    occupied_ = waiting_[next];
    waiting_[next] = false;
    return occupied_ ? std::optional(next_) : std::nullopt;
  }

 private:
  tbb::spin_mutex mutex_;  // held for a few instructions
  int next_ = 0;
  bool occupied_ = false;
  std::vector<bool> waiting_;
};

/// A pipeline whose steps are tasks of the arenas. No task waits for another: a frame whose turn
/// has not come is left, and taken up again by the one that it waits for.
class FrameRun {
 public:
  FrameRun(const std::vector<std::unique_ptr<NodeArena>>& nodes, FramePlaces places,
           const FrameSteps& steps)
      : nodes_(nodes),
        places_(std::move(places)),
        steps_(steps),
        reading_(slots()),
        computing_(slots()),
        writing_(slots()) {}

  /// `caller_works`: as in run_frames_on_nodes().
  void run(bool caller_works) {
    for (int slot = 0; slot < slots(); ++slot) {
      if (reading_.arrive(slot)) {
        post(Step::kRead, slot);
      }
    }
    const auto wait = [this] { tasks_.wait(); };
    if (caller_works) {
      nodes_.front()->arena().execute(wait);
    } else {
      wait();
    }
  }

 private:
  enum class Step { kRead, kCompute, kWrite };  // where a frame is taken up

  [[nodiscard]] int slots() const { return static_cast<int>(places_.node_of_slot.size()); }

  void post(Step from, int slot) {
    const int index = places_.node_of_slot[static_cast<std::size_t>(slot)];
    NodeArena& node = *nodes_[static_cast<std::size_t>(index)];
    node.arena().enqueue(tasks_.defer([this, &node, from, slot] {
      const NodeVisit inside(node, places_.loops_stay);
      go_on(from, slot);
    }));
  }
  void post_next(Step from, Turnstile& turnstile) {
    if (const std::optional<int> slot = turnstile.leave()) {
      post(from, *slot);
    }
  }

  /// Takes the frame in `slot` as far as it can go.
  void go_on(Step from, int slot) {
    if (from == Step::kRead) {
      if (!steps_.read(slot)) {
        return;  // and so nobody reads any more
      }
      post_next(Step::kRead, reading_);
      steps_.prepare(slot);
      if (steps_.compute_in_order && !computing_.arrive(slot)) {
        return;
      }
    }
    if (from != Step::kWrite) {
      steps_.compute(slot);
      if (steps_.compute_in_order) {
        post_next(Step::kCompute, computing_);
      }
      steps_.encode(slot);
      if (!writing_.arrive(slot)) {
        return;
      }
    }
    steps_.write(slot);
    post_next(Step::kWrite, writing_);
    if (reading_.arrive(slot)) {
      post(Step::kRead, slot);
    }
  }

  const std::vector<std::unique_ptr<NodeArena>>& nodes_;
  FramePlaces places_;
  const FrameSteps& steps_;
  Turnstile reading_;
  Turnstile computing_;
  Turnstile writing_;
  tbb::task_group tasks_;
};

/// Each slot goes to the node that lacks most of its share.
std::vector<int> deal(int slots, const std::vector<int>& threads_of_nodes) {
  const int threads = std::accumulate(threads_of_nodes.begin(), threads_of_nodes.end(), 0);
  std::vector<int> dealt(threads_of_nodes.size());
  std::vector<int> node_of_slot;
  for (int slot = 1; slot <= slots; ++slot) {
    std::size_t neediest = 0;
    const auto lack = [&](std::size_t node) {
      return slot * threads_of_nodes[node] - dealt[node] * threads;
    };
    for (std::size_t node = 1; node < dealt.size(); ++node) {
      if (lack(node) > lack(neediest)) {
        neediest = node;
      }
    }
    ++dealt[neediest];
    node_of_slot.push_back(static_cast<int>(neediest));
  }
  return node_of_slot;
}

/// All slots make equally many frames, so a node with a slot too many is what others wait for.
bool is_fair(const std::vector<int>& node_of_slot, const std::vector<int>& threads_of_nodes) {
  constexpr double kMaxExcess = 1.25;
  const int threads = std::accumulate(threads_of_nodes.begin(), threads_of_nodes.end(), 0);
  for (std::size_t node = 0; node < threads_of_nodes.size(); ++node) {
    const auto dealt = std::ranges::count(node_of_slot, static_cast<int>(node));
    const double share =
        static_cast<double>(node_of_slot.size()) * threads_of_nodes[node] / threads;
    if (dealt < 1 || static_cast<double>(dealt) > kMaxExcess * share) {
      return false;
    }
  }
  return true;
}

}  // namespace

FramePlaces place_frames(int in_flight, bool compute_in_order,
                         const std::vector<int>& threads_of_nodes) {
  if (!compute_in_order) {
    for (int slots = in_flight; slots >= static_cast<int>(threads_of_nodes.size()); --slots) {
      std::vector<int> node_of_slot = deal(slots, threads_of_nodes);
      if (is_fair(node_of_slot, threads_of_nodes)) {
        return {std::move(node_of_slot), true};
      }
    }
  }
  return {deal(in_flight, threads_of_nodes), false};
}

void run_frames_on_nodes(const std::vector<std::unique_ptr<NodeArena>>& nodes, bool caller_works,
                         int in_flight, const FrameSteps& steps) {
  std::vector<int> threads_of_nodes;
  for (const std::unique_ptr<NodeArena>& node : nodes) {
    threads_of_nodes.push_back(node->thread_count());
  }
  FrameRun(nodes, place_frames(in_flight, steps.compute_in_order, threads_of_nodes), steps)
      .run(caller_works);
}

}  // namespace vantage::scheduler
