#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "scheduler/executor.h"

namespace vantage::scheduler {

struct ExecutorCase {
  std::string name;
  int threads;
  std::function<std::unique_ptr<Executor>()> make;
  bool from_many_threads = true;  ///< may be called by several threads at a time
};

/// What test runners print of a case instead of its bytes.
inline void PrintTo(const ExecutorCase& executor, std::ostream* stream) {
  *stream << executor.name << " with " << executor.threads << " threads";
}

inline std::string executor_test_name(const testing::TestParamInfo<ExecutorCase>& info) {
  return info.param.name + std::to_string(info.param.threads);
}

/// Every kind of executor with 1, 2 and 5 threads, as far as it has threads.
inline std::vector<ExecutorCase> executor_cases() {
  std::vector<ExecutorCase> cases;
  cases.push_back({"serial", 1, [] { return make_executor(ExecutorKind::kSerial, 1); }});
  cases.push_back({"shuffled", 1, [] { return make_shuffled_executor(7); }, false});
  for (const int threads : {1, 2, 5}) {
    cases.push_back(
        {"tbb", threads, [threads] { return make_executor(ExecutorKind::kTbb, threads); }});
    cases.push_back(
        {"openmp", threads, [threads] { return make_executor(ExecutorKind::kOpenMp, threads); }});
  }
  return cases;
}

}  // namespace vantage::scheduler
