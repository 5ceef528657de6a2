#include "scheduler/topology.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <set>
#include <stdexcept>
#include <string>

#include "scheduler/control_groups.h"

namespace vantage::scheduler::topology_test {

using testing::ElementsAre;

TEST(Topology, KnowsTheCoresOfEachNode) {
  const Topology two = synthetic_topology("node:2 core:2 pu:2");
  ASSERT_EQ(two.nodes.size(), 2U);
  EXPECT_EQ(two.nodes[0].number, 0);
  EXPECT_EQ(two.nodes[1].number, 1);
  EXPECT_THAT(two.nodes[0].cores, ElementsAre(Core{0, 1}, Core{2, 3}));
  EXPECT_THAT(two.nodes[1].cores, ElementsAre(Core{4, 5}, Core{6, 7}));
  EXPECT_EQ(two.nodes[1].hardware_threads(), 4);
  EXPECT_GT(two.nodes[1].memory_bytes, 0U);
  EXPECT_EQ(two.machine.numa_nodes, 2);
  EXPECT_EQ(two.machine.cores, 4);
  EXPECT_EQ(two.machine.hardware_threads, 8);
}

TEST(Topology, TakesMachinesAsTheyCome) {
  struct Case {
    std::string description;
    int nodes;
    int cores;
    int threads;
  };
  const Case cases[] = {{"core:3 pu:1", 1, 3, 3},
                        {"pack:2 node:2 core:3 pu:1", 4, 12, 12},
                        {"pack:2 core:3 pu:2", 1, 6, 12},
                        {"pack:4 node:2 core:16 pu:2", 8, 128, 256},
                        {"node:2 pu:3", 2, 6, 6},  // hardware threads without cores
                        {"pu:1", 1, 1, 1}};
  for (const Case& one : cases) {
    const Topology topology = synthetic_topology(one.description);
    EXPECT_EQ(topology.machine.numa_nodes, one.nodes) << one.description;
    EXPECT_EQ(static_cast<int>(topology.nodes.size()), one.nodes) << one.description;
    EXPECT_EQ(topology.machine.cores, one.cores) << one.description;
    EXPECT_EQ(topology.machine.hardware_threads, one.threads) << one.description;
    std::set<int> numbers;
    for (const NumaNode& node : topology.nodes) {
      for (const Core& core : node.cores) {
        EXPECT_FALSE(core.empty());
        numbers.insert(core.begin(), core.end());
      }
    }
    EXPECT_EQ(static_cast<int>(numbers.size()), one.threads) << one.description;
  }
}

TEST(Topology, MemoryOfTwoKindsIsOneNode) {
  const Topology topology = synthetic_topology("pack:2 [numa] [numa] core:2 pu:1");
  EXPECT_EQ(topology.nodes.size(), 2U);
  EXPECT_EQ(topology.machine.hardware_threads, 4);
}

TEST(Topology, OfAnotherMachineIsNotForBinding) {
  EXPECT_EQ(synthetic_topology("node:2 core:1 pu:1").system, nullptr);
}

TEST(Topology, RefusesOtherDescriptions) {
  for (const std::string bad : {"", "two nodes", "node:0", "node:2 core:x"}) {
    EXPECT_THROW(synthetic_topology(bad), std::invalid_argument) << bad;
  }
}

TEST(Topology, OfThisMachineIsWhatThisProcessMayUse) {
  const Topology topology = detect_topology();
  if (topology.system == nullptr) {
    GTEST_SKIP() << "HWLOC_SYNTHETIC or HWLOC_XMLFILE stands for another machine";
  }
  cpu_set_t mask;
  ASSERT_EQ(sched_getaffinity(0, sizeof mask, &mask), 0);
  const SystemLimits limits = read_system_limits();
  EXPECT_EQ(topology.machine.hardware_threads, limits.threads_of(CPU_COUNT(&mask)));
  EXPECT_EQ(topology.machine.memory_bytes, limits.memory_bytes);
  for (const NumaNode& node : topology.nodes) {
    for (const Core& core : node.cores) {
      for (const int hardware_thread : core) {
        EXPECT_TRUE(CPU_ISSET(static_cast<std::size_t>(hardware_thread), &mask));
      }
    }
  }
}

}  // namespace vantage::scheduler::topology_test
