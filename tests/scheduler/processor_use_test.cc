#include "scheduler/processor_use.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <thread>

namespace vantage::scheduler::processor_use_test {

using Clock = std::chrono::steady_clock;

void work_for(std::chrono::milliseconds time) {
  const Clock::time_point end = Clock::now() + time;
  while (Clock::now() < end) {
  }
}

TEST(ProcessorUse, IsThatOfOtherProcesses) {
  using std::chrono::milliseconds;
  const ProcessorUse use;
  if (!use.of_others()) {
    GTEST_SKIP() << "the system does not tell";
  }
  // What else runs on the machine counts as well, so only bounds from below are sure.
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    for (;;) {
    }
  }
  const ProcessorUse beside_child;
  std::this_thread::sleep_for(milliseconds(300));
  const double others = beside_child.of_others().value();
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_GT(others, 0.2) << "a child that does nothing but run, on a machine that may be shared";
}

TEST(ProcessorUse, IsNotThatOfThisProcess) {
  // Once idle and once at work: own work adds nothing, whatever others do meanwhile.
  double min_excess = 1e9;
  for (int attempt = 0; attempt < 3 && min_excess > 0.5; ++attempt) {
    const ProcessorUse idle;
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    const auto while_idle = idle.of_others();
    if (!while_idle) {
      GTEST_SKIP() << "the system does not tell";
    }
    const ProcessorUse busy;
    work_for(std::chrono::milliseconds(150));
    min_excess = std::min(min_excess, busy.of_others().value() - *while_idle);
  }
  EXPECT_LE(min_excess, 0.5);
}

}  // namespace vantage::scheduler::processor_use_test
