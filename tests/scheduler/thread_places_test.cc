#include "scheduler/thread_places.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace vantage::scheduler::thread_places_test {

using testing::ElementsAre;

std::vector<int> threads_on(const std::string& topology, int threads,
                            ThreadBinding binding = ThreadBinding::kNodes) {
  return place_threads(synthetic_topology(topology), threads, binding).threads_of_nodes();
}

TEST(ThreadPlaces, UseAsManyNodesAsGiveEachThreadACore) {
  EXPECT_THAT(threads_on("node:2 core:4 pu:2", 1), ElementsAre(1));
  EXPECT_THAT(threads_on("node:2 core:4 pu:2", 4), ElementsAre(4));
  EXPECT_THAT(threads_on("node:2 core:4 pu:2", 6), ElementsAre(3, 3));
  EXPECT_THAT(threads_on("node:2 core:4 pu:2", 8), ElementsAre(4, 4));
  EXPECT_THAT(threads_on("node:2 core:4 pu:2", 16), ElementsAre(8, 8));
  EXPECT_THAT(threads_on("node:2 core:4 pu:2", 100), ElementsAre(50, 50));
  EXPECT_THAT(threads_on("pack:2 node:2 core:3 pu:1", 7), ElementsAre(2, 3, 2));
  EXPECT_THAT(threads_on("node:8 core:1 pu:1", 3), ElementsAre(1, 1, 1));
  EXPECT_THAT(threads_on("core:4 pu:2", 5), ElementsAre(5));
  EXPECT_THAT(threads_on("pack:4 node:2 core:16 pu:2", 256), testing::Each(32));
}

TEST(ThreadPlaces, NodesMayDiffer) {
  Topology topology;
  topology.nodes = {{.number = 0, .cores = {{0}}, .memory_bytes = 0},
                    {.number = 3, .cores = {{1}, {2}, {3}, {4}, {5}, {6}, {7}}, .memory_bytes = 0}};
  const ThreadPlaces all = place_threads(topology, 8, ThreadBinding::kCores);
  EXPECT_THAT(all.threads_of_nodes(), ElementsAre(1, 7));
  EXPECT_EQ(all.nodes[1].number, 3);
  // Of two threads neither belongs on the small node.
  const ThreadPlaces two = place_threads(topology, 2, ThreadBinding::kCores);
  ASSERT_EQ(two.nodes.size(), 1U);
  EXPECT_EQ(two.nodes[0].number, 3);
  EXPECT_EQ(two.thread_count(), 2);
}

TEST(ThreadPlaces, OnNodesAThreadMayUseAllOfItsNode) {
  const ThreadPlaces places =
      place_threads(synthetic_topology("node:2 core:2 pu:2"), 4, ThreadBinding::kNodes);
  for (const std::vector<int>& allowed : places.nodes.at(1).allowed) {
    EXPECT_THAT(allowed, ElementsAre(4, 5, 6, 7));
  }
}

TEST(ThreadPlaces, OnCoresEachThreadHasItsOwnUntilThereAreNoMore) {
  const Topology topology = synthetic_topology("node:2 core:3 pu:2");
  const auto cores_of = [&](int threads) {
    std::vector<std::vector<int>> cores;
    for (const NodeThreads& node : place_threads(topology, threads, ThreadBinding::kCores).nodes) {
      cores.insert(cores.end(), node.allowed.begin(), node.allowed.end());
    }
    return cores;
  };
  EXPECT_THAT(cores_of(2), ElementsAre(Core{0, 1}, Core{2, 3}));
  for (const int threads : {1, 3, 4, 5, 6}) {
    const auto cores = cores_of(threads);
    EXPECT_EQ(static_cast<int>(std::set(cores.begin(), cores.end()).size()), threads);
  }
  const auto twice = cores_of(12);
  for (const auto& core : twice) {
    EXPECT_EQ(std::ranges::count(twice, core), 2);
  }
}

TEST(ThreadPlaces, WithoutBindingThereIsOneNode) {
  const ThreadPlaces places =
      place_threads(synthetic_topology("node:2 core:4 pu:2"), 16, ThreadBinding::kNone);
  EXPECT_THAT(places.threads_of_nodes(), ElementsAre(16));
  EXPECT_THAT(places.nodes[0].allowed, testing::Each(testing::IsEmpty()));
}

TEST(ThreadPlaces, DefaultIsNodesWhereOneIsNotEnough) {
  const Topology two = synthetic_topology("node:2 core:4 pu:2");
  EXPECT_EQ(default_binding(two, 4), ThreadBinding::kNone);
  EXPECT_EQ(default_binding(two, 5), ThreadBinding::kNodes);
  EXPECT_EQ(default_binding(synthetic_topology("core:4 pu:2"), 100), ThreadBinding::kNone);
}

TEST(ThreadPlaces, SerialExecutorsHaveNone) {
  const ThreadPlaces places =
      place_threads(synthetic_topology("node:2 core:4 pu:2"), 1, ThreadBinding::kCores);
  EXPECT_THROW(make_executor(ExecutorKind::kSerial, places), std::invalid_argument);
}

TEST(DivideInProportion, RoundsEveryPartToANeighbour) {
  const std::vector<std::vector<int>> weights = {{1}, {1, 1}, {3, 5}, {1, 0, 31}, {7, 7, 7, 2}};
  for (const std::vector<int>& one : weights) {
    const int sum = std::accumulate(one.begin(), one.end(), 0);
    for (const int total : {0, 1, 2, 3, 10, 1001, 1 << 30}) {
      const std::vector<int> parts = divide_in_proportion(total, one);
      ASSERT_EQ(parts.size(), one.size());
      EXPECT_EQ(std::accumulate(parts.begin(), parts.end(), 0), total);
      for (std::size_t k = 0; k < one.size(); ++k) {
        const double exact = static_cast<double>(total) * one[k] / sum;
        EXPECT_GE(parts[k], 0);
        EXPECT_LT(std::abs(parts[k] - exact), 1.0 + 1e-9) << total << " among " << one.size();
      }
    }
  }
}

}  // namespace vantage::scheduler::thread_places_test
