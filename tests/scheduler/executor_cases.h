#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "scheduler/executor.h"
#include "scheduler/thread_places.h"
#include "scheduler/topology.h"

namespace vantage::scheduler {

struct ExecutorCase {
  std::string name;
  int threads;
  std::function<std::unique_ptr<Executor>()> make;
  bool from_many_threads = true;  ///< may be called by several threads at a time
  std::string where = {};         ///< its threads are placed, for the name of the test
};

/// What test runners print of a case instead of its bytes.
inline void PrintTo(const ExecutorCase& executor, std::ostream* stream) {
  *stream << executor.name << " with " << executor.threads << " threads " << executor.where;
}

inline std::string executor_test_name(const testing::TestParamInfo<ExecutorCase>& info) {
  return info.param.name + std::to_string(info.param.threads) + info.param.where;
}

/// Machines for executors with places, and how many threads.
struct PlacedCase {
  std::string where;
  std::string topology;
  int threads;
  ThreadBinding binding = ThreadBinding::kNodes;
};

inline std::vector<PlacedCase> placed_cases() {
  return {{"OnOneNode", "node:1 core:4 pu:1", 3},
          {"OnOneCore", "node:2 core:4 pu:2", 1},
          {"OnTwoNodes", "node:2 core:4 pu:2", 5},
          {"OnEachCore", "node:2 core:4 pu:2", 8, ThreadBinding::kCores},
          {"OnEachHardwareThread", "pack:2 node:2 core:3 pu:2", 24},
          {"OnTinyNodes", "node:4 core:1 pu:1", 3},
          {"OnTooFewCores", "node:3 core:1 pu:1", 7, ThreadBinding::kCores}};
}

/// Every kind of executor with 1, 2 and 5 threads, as far as it has threads, and those that place
/// their threads.
inline std::vector<ExecutorCase> executor_cases() {
  std::vector<ExecutorCase> cases;
  cases.push_back({"serial", 1, [] { return make_executor(ExecutorKind::kSerial, 1); }});
  cases.push_back({"shuffled", 1, [] { return make_shuffled_executor(7); }, false});
  for (const auto& [name, kind] :
       {std::pair("tbb", ExecutorKind::kTbb), std::pair("openmp", ExecutorKind::kOpenMp)}) {
    for (const int threads : {1, 2, 5}) {
      cases.push_back({name, threads, [=] { return make_executor(kind, threads); }});
    }
    for (const PlacedCase& placed : placed_cases()) {
      const auto make = [=] {
        return make_executor(kind, place_threads(synthetic_topology(placed.topology),
                                                 placed.threads, placed.binding));
      };
      cases.push_back({name, placed.threads, make, true, placed.where});
    }
  }
  return cases;
}

}  // namespace vantage::scheduler
