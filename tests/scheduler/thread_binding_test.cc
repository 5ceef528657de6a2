// Where threads run: on this machine as far as it has cores, on simulated ones as planned.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "scheduler/frame_pipeline.h"
#include "scheduler/tbb_node_arena.h"
#include "scheduler/tbb_node_frames.h"
#include "scheduler/thread_places.h"
#include "scheduler/topology.h"

namespace vantage::scheduler::thread_binding_test {

using testing::ElementsAre;

/// Hardware threads that the calling thread may run on.
std::set<int> own_mask() {
  cpu_set_t mask;
  std::set<int> numbers;
  if (sched_getaffinity(0, sizeof mask, &mask) == 0) {
    for (int number = 0; number < CPU_SETSIZE; ++number) {
      if (CPU_ISSET(static_cast<std::size_t>(number), &mask)) {
        numbers.insert(number);
      }
    }
  }
  return numbers;
}

/// The masks of all threads that take part in a loop, which lasts until `threads` do or for a
/// second.
std::map<std::thread::id, std::set<int>> masks_in(Executor& executor, int threads) {
  std::mutex mutex;
  std::map<std::thread::id, std::set<int>> masks;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(1);
  executor.parallel_for(4 * threads, [&](int) {
    {
      const std::lock_guard lock(mutex);
      masks[std::this_thread::get_id()] = own_mask();
    }
    const auto all_are_here = [&] {
      const std::lock_guard lock(mutex);
      return static_cast<int>(masks.size()) >= threads;
    };
    while (!all_are_here() && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::yield();
    }
  });
  return masks;
}

class BindingOnThisMachine : public testing::TestWithParam<ExecutorKind> {
 protected:
  void SetUp() override {
    if (topology_.system == nullptr || topology_.machine.cores < 2) {
      GTEST_SKIP() << "needs two cores of this machine";
    }
  }
  [[nodiscard]] const Topology& topology() const { return topology_; }

 private:
  Topology topology_ = detect_topology();
};
INSTANTIATE_TEST_SUITE_P(Kinds, BindingOnThisMachine,
                         testing::Values(ExecutorKind::kTbb, ExecutorKind::kOpenMp),
                         [](const auto& kind) {
                           return kind.param == ExecutorKind::kTbb ? "tbb" : "openmp";
                         });

TEST_P(BindingOnThisMachine, CoresAreDifferentOnesAndMasksComeBack) {
  const std::set<int> before = own_mask();
  {
    const auto executor = make_executor(GetParam(), 2, ThreadBinding::kCores);
    for (int round = 0; round < 3; ++round) {
      const auto masks = masks_in(*executor, 2);
      ASSERT_EQ(masks.size(), 2U) << "one thread did not come";
      std::set<std::set<int>> different;
      for (const auto& [thread, mask] : masks) {
        EXPECT_LT(mask.size(), before.size());
        different.insert(mask);
      }
      EXPECT_EQ(different.size(), 2U) << "both threads are on one core";
      EXPECT_EQ(own_mask(), before);
    }
  }
  // The threads go on to work for others, unbound.
  const auto unbound = make_executor(GetParam(), 2, ThreadBinding::kNone);
  for (const auto& [thread, mask] : masks_in(*unbound, 2)) {
    EXPECT_EQ(mask, before);
  }
}

TEST_P(BindingOnThisMachine, NodesAreThoseOfThePlaces) {
  const int threads = 2;
  const ThreadPlaces places = place_threads(topology(), threads, ThreadBinding::kNodes);
  std::set<std::set<int>> planned;
  for (const NodeThreads& node : places.nodes) {
    for (const std::vector<int>& allowed : node.allowed) {
      planned.emplace(allowed.begin(), allowed.end());
    }
  }
  const auto executor = make_executor(GetParam(), places);
  for (const auto& [thread, mask] : masks_in(*executor, threads)) {
    EXPECT_TRUE(planned.contains(mask));
  }
}

TEST_P(BindingOnThisMachine, FramesAreBoundToo) {
  const std::set<int> before = own_mask();
  const auto executor = make_executor(GetParam(), 2, ThreadBinding::kCores);
  int frames = 0;
  std::atomic<int> unbound{0};
  const auto look = [&](int) { unbound += own_mask().size() < before.size() ? 0 : 1; };
  FrameSteps steps;
  steps.read = [&](int slot) {
    look(slot);
    return frames++ < 20;
  };
  steps.prepare = look;
  steps.compute = [&](int slot) {
    look(slot);
    executor->parallel_for(8, look);
  };
  steps.encode = look;
  steps.write = look;
  EXPECT_EQ(run_frames(*executor, 3, steps).frames_written, 20);
  EXPECT_EQ(unbound, 0);
  EXPECT_EQ(own_mask(), before);
}

TEST_P(BindingOnThisMachine, AnErrorBringsMasksBack) {
  const std::set<int> before = own_mask();
  const auto executor = make_executor(GetParam(), 2, ThreadBinding::kCores);
  EXPECT_THROW(executor->parallel_for(10, [](int) { throw std::runtime_error("task"); }),
               std::runtime_error);
  EXPECT_EQ(own_mask(), before);
}

TEST(BindingElsewhere, LeavesThreadsAlone) {
  const std::set<int> before = own_mask();
  const ThreadPlaces places =
      place_threads(synthetic_topology("node:2 core:1 pu:1"), 2, ThreadBinding::kCores);
  for (const ExecutorKind kind : {ExecutorKind::kTbb, ExecutorKind::kOpenMp}) {
    const auto executor = make_executor(kind, places);
    for (const auto& [thread, mask] : masks_in(*executor, 2)) {
      EXPECT_EQ(mask, before);
    }
  }
}

TEST(FramePlaces, GiveEachNodeItsShareOrNone) {
  const auto slots = [](int in_flight, const std::vector<int>& threads, bool in_order = false) {
    return place_frames(in_flight, in_order, threads).node_of_slot;
  };
  const auto stays = [](int in_flight, const std::vector<int>& threads, bool in_order = false) {
    return place_frames(in_flight, in_order, threads).loops_stay;
  };
  EXPECT_THAT(slots(4, {8, 8}), ElementsAre(0, 1, 0, 1));
  EXPECT_TRUE(stays(4, {8, 8}));
  EXPECT_THAT(slots(3, {8, 8}), ElementsAre(0, 1)) << "a third one would be too many for its node";
  EXPECT_THAT(slots(3, {8, 4}), ElementsAre(0, 1, 0));
  EXPECT_THAT(slots(1, {8, 8}), ElementsAre(0));
  EXPECT_FALSE(stays(1, {8, 8})) << "node 1 would have nothing to do";
  EXPECT_THAT(slots(5, {8, 8}, true), ElementsAre(0, 1, 0, 1, 0));
  EXPECT_FALSE(stays(5, {8, 8}, true)) << "one frame is computed at a time";
  EXPECT_FALSE(stays(2, {1, 7}));
  EXPECT_TRUE(stays(8, {1, 7}));
  EXPECT_TRUE(stays(1, {5}));
}

/// Nodes that loops within the computation of each slot ran on.
std::map<int, std::set<int>> nodes_of_loops(const ThreadPlaces& places, int in_flight,
                                            bool in_order) {
  const auto executor = make_executor(ExecutorKind::kTbb, places);
  std::mutex mutex;
  std::map<int, std::set<int>> nodes;
  int frames = 0;
  FrameSteps steps;
  steps.read = [&](int) { return frames++ < 40; };
  steps.prepare = [](int) {};
  steps.compute = [&](int slot) {
    executor->parallel_for(6, [&](int) {
      executor->parallel_for(3, [&](int) {
        const std::lock_guard lock(mutex);
        nodes[slot].insert(NodeVisit::innermost()->arena().node());
      });
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    });
  };
  steps.encode = [](int) {};
  steps.write = [](int) {};
  steps.compute_in_order = in_order;
  run_frames(*executor, in_flight, steps);
  return nodes;
}

TEST(FramesOnNodes, LoopsStayWithTheirFrame) {
  const ThreadPlaces places =
      place_threads(synthetic_topology("node:2 core:2 pu:1"), 4, ThreadBinding::kNodes);
  const std::map<int, std::set<int>> expected = {{0, {0}}, {1, {1}}, {2, {0}}, {3, {1}}};
  EXPECT_EQ(nodes_of_loops(places, 4, false), expected);
}

TEST(FramesOnNodes, LoopsOfFramesInOrderUseAllNodes) {
  const ThreadPlaces places =
      place_threads(synthetic_topology("node:2 core:2 pu:1"), 4, ThreadBinding::kNodes);
  std::set<int> all;
  for (const auto& [slot, nodes] : nodes_of_loops(places, 4, true)) {
    all.insert(nodes.begin(), nodes.end());
    EXPECT_EQ(nodes.size(), 2U) << "slot " << slot;
  }
  EXPECT_THAT(all, ElementsAre(0, 1));
}

TEST(LoopsOnNodes, AllNodesTakePart) {
  const ThreadPlaces places =
      place_threads(synthetic_topology("node:3 core:1 pu:1"), 3, ThreadBinding::kNodes);
  const auto executor = make_executor(ExecutorKind::kTbb, places);
  std::mutex mutex;
  std::set<int> nodes;
  executor->parallel_for(300, [&](int) {
    {
      const std::lock_guard lock(mutex);
      nodes.insert(NodeVisit::innermost()->arena().node());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  EXPECT_THAT(nodes, ElementsAre(0, 1, 2));
}

}  // namespace vantage::scheduler::thread_binding_test
