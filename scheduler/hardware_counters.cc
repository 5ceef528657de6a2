#include "scheduler/hardware_counters.h"

#include <linux/perf_event.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>

namespace vantage::scheduler {
namespace {

constexpr std::uint64_t cache_event(std::uint64_t cache, std::uint64_t result) {
  return cache | PERF_COUNT_HW_CACHE_OP_READ << 8U | result << 16U;
}

constexpr std::array<CountedEvent, 13> kEvents = {{
    {"cycles", PERF_TYPE_HARDWARE, PERF_COUNT_HW_CPU_CYCLES},
    {"instructions", PERF_TYPE_HARDWARE, PERF_COUNT_HW_INSTRUCTIONS},
    {"branches", PERF_TYPE_HARDWARE, PERF_COUNT_HW_BRANCH_INSTRUCTIONS},
    {"branch misses", PERF_TYPE_HARDWARE, PERF_COUNT_HW_BRANCH_MISSES},
    {"cache references", PERF_TYPE_HARDWARE, PERF_COUNT_HW_CACHE_REFERENCES},
    {"cache misses", PERF_TYPE_HARDWARE, PERF_COUNT_HW_CACHE_MISSES},
    {"L1 data loads", PERF_TYPE_HW_CACHE,
     cache_event(PERF_COUNT_HW_CACHE_L1D, PERF_COUNT_HW_CACHE_RESULT_ACCESS)},
    {"L1 data load misses", PERF_TYPE_HW_CACHE,
     cache_event(PERF_COUNT_HW_CACHE_L1D, PERF_COUNT_HW_CACHE_RESULT_MISS)},
    {"last-level loads", PERF_TYPE_HW_CACHE,
     cache_event(PERF_COUNT_HW_CACHE_LL, PERF_COUNT_HW_CACHE_RESULT_ACCESS)},
    {"last-level load misses", PERF_TYPE_HW_CACHE,
     cache_event(PERF_COUNT_HW_CACHE_LL, PERF_COUNT_HW_CACHE_RESULT_MISS)},
    {"page faults", PERF_TYPE_SOFTWARE, PERF_COUNT_SW_PAGE_FAULTS},
    {"context switches", PERF_TYPE_SOFTWARE, PERF_COUNT_SW_CONTEXT_SWITCHES, false},
    {"processor moves", PERF_TYPE_SOFTWARE, PERF_COUNT_SW_CPU_MIGRATIONS, false},
}};

bool is_refusal(int error) { return error == EACCES || error == EPERM; }

/// Why an event cannot be counted, to follow "not counted: cycles, …: ".
std::string reason_for(int error) {
  switch (error) {
    case EACCES:
    case EPERM: {
      std::string level;
      std::ifstream("/proc/sys/kernel/perf_event_paranoid") >> level;
      return "not permitted (kernel.perf_event_paranoid is " +
             (level.empty() ? "not to be read" : level) +
             "), expected a lower value or the capability CAP_PERFMON";
    }
    case ENOENT:
    case EOPNOTSUPP:
    case ENODEV:
    case ENXIO:
      return "this machine has no such counters or hides them, as virtual machines do";
    case ENOSYS:
      return "the kernel, or the container, is without perf_event_open";
    default:
      return "perf_event_open: " + std::generic_category().message(error);
  }
}

}  // namespace

int HardwareCounters::open_for_programs(const CountedEvent& event, bool with_kernel) {
  perf_event_attr attributes;
  std::memset(&attributes, 0, sizeof attributes);
  attributes.size = sizeof attributes;
  attributes.type = event.type;
  attributes.config = event.config;
  attributes.read_format = PERF_FORMAT_TOTAL_TIME_ENABLED | PERF_FORMAT_TOTAL_TIME_RUNNING;
  // Off for this thread, which never execs; programs it forks inherit the counter and switch it on.
  attributes.disabled = 1;
  attributes.inherit = 1;
  attributes.enable_on_exec = 1;
  attributes.exclude_kernel = with_kernel ? 0 : 1;
  attributes.exclude_hv = attributes.exclude_kernel;
  constexpr pid_t kThisThread = 0;
  constexpr int kAnyProcessor = -1;
  constexpr int kNoGroup = -1;
  const long descriptor = ::syscall(SYS_perf_event_open, &attributes, kThisThread, kAnyProcessor,
                                    kNoGroup, PERF_FLAG_FD_CLOEXEC);
  return descriptor < 0 ? -errno : static_cast<int>(descriptor);
}

HardwareCounters::HardwareCounters(const Opener& open) {
  counters_.reserve(kEvents.size());
  for (const CountedEvent& event : kEvents) {
    open_event(event, open);
  }
}

HardwareCounters::~HardwareCounters() {
  for (const Counter& counter : counters_) {
    ::close(counter.descriptor);
  }
}

void HardwareCounters::open_event(const CountedEvent& event, const Opener& open) {
  int descriptor = open(event, true);
  if (is_refusal(-descriptor) && event.counts_in_user_mode) {
    descriptor = open(event, false);
    user_mode_only_ = user_mode_only_ || descriptor >= 0;
  }
  if (descriptor >= 0) {
    counters_.push_back({event.name, descriptor});
  } else {
    add_gap(gaps_, event.name, reason_for(-descriptor));
  }
}

void HardwareCounters::add_gap(std::vector<Gap>& gaps, std::string_view event, std::string reason) {
  const auto known = std::ranges::find(gaps, reason, &Gap::reason);
  if (known != gaps.end()) {
    known->events.push_back(event);
  } else {
    gaps.push_back({std::move(reason), {event}});
  }
}

EventCounts HardwareCounters::read() const {
  EventCounts result;
  result.user_mode_only = user_mode_only_;
  std::vector<Gap> gaps = gaps_;
  for (const Counter& counter : counters_) {
    struct {
      std::uint64_t events;
      std::uint64_t enabled_ns;
      std::uint64_t running_ns;
    } value = {};
    if (::read(counter.descriptor, &value, sizeof value) != sizeof value) {
      add_gap(gaps, counter.name, "the counter cannot be read");
    } else if (value.running_ns == 0 && value.enabled_ns > 0) {
      add_gap(gaps, counter.name, "the processor's counters were all in use");
    } else {
      const double share = value.enabled_ns == 0 ? 1
                                                 : static_cast<double>(value.running_ns) /
                                                       static_cast<double>(value.enabled_ns);
      result.counts.push_back({counter.name, static_cast<double>(value.events) / share});
    }
  }
  for (const Gap& gap : gaps) {
    std::string sentence = "not counted: ";
    for (const std::string_view event : gap.events) {
      sentence.append(event == gap.events.front() ? "" : ", ").append(event);
    }
    result.absence += (result.absence.empty() ? "" : "; ") + sentence + ": " + gap.reason;
  }
  return result;
}

}  // namespace vantage::scheduler
