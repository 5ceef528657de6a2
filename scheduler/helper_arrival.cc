#include "scheduler/helper_arrival.h"

#include <sched.h>

#include <chrono>
#include <cstdio>
#include <memory>

namespace vantage::scheduler {
namespace {

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// Differs between threads.
const void* this_thread() {
  thread_local const char mark = 0;
  return &mark;
}

}  // namespace

HelperArrival::Work::Work(HelperArrival& arrival, bool wakes_helpers) : arrival_(arrival) {
  if (arrival_.works_.fetch_add(1) > 0 || !wakes_helpers) {
    return;
  }
  const std::int64_t now = now_ns();
  if (now - arrival_.end_ns_ > arrival_.pause_.count()) {
    arrival_.start_ns_ = now;
    arrival_.caller_ = this_thread();
    arrival_.is_awaited_ = true;
  }
}

HelperArrival::Work::~Work() {
  if (arrival_.works_.fetch_sub(1) == 1) {
    arrival_.end_ns_ = now_ns();
  }
}

bool HelperArrival::look() {
  if (caller_ != this_thread()) {
    is_awaited_ = false;
    return false;
  }
  // One that comes now comes too late: the move is then for nothing.
  return now_ns() - start_ns_ > patience_.count() && is_awaited_.exchange(false) && move_();
}

bool leave_core() {
  cpu_set_t allowed;
  const int here = sched_getcpu();
  if (here < 0 || sched_getaffinity(0, sizeof(allowed), &allowed) != 0) {
    return false;
  }
  cpu_set_t others = allowed;
  CPU_CLR(static_cast<unsigned>(here), &others);
  if (CPU_COUNT(&others) == 0 || sched_setaffinity(0, sizeof(others), &others) != 0) {
    return false;
  }
  sched_setaffinity(0, sizeof(allowed), &allowed);
  return true;
}

bool move_to_idle_core() {
  // Three load averages, then the number of threads that run or wait for a core.
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen("/proc/loadavg", "r"),
                                                             std::fclose);
  int runnable = 0;
  if (file == nullptr || std::fscanf(file.get(), "%*f %*f %*f %d", &runnable) != 1) {
    return false;
  }
  cpu_set_t allowed;
  return sched_getaffinity(0, sizeof(allowed), &allowed) == 0 && runnable <= CPU_COUNT(&allowed) &&
         leave_core();
}

}  // namespace vantage::scheduler
