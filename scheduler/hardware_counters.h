#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace vantage::scheduler {

/// One event that is counted, as perf_event_open(2) names it.
struct CountedEvent {
  std::string_view name;
  std::uint32_t type = 0;
  std::uint64_t config = 0;
  /// Counted in user mode alone where the kernel's part may not be seen; false: happens in the
  /// kernel only.
  bool counts_in_user_mode = true;
};

/// What was counted.
struct EventCounts {
  struct Count {
    std::string_view name;
    double events = 0;  ///< estimated where counters took turns
  };
  std::vector<Count> counts;
  /// The kernel's share of the work was not to be seen.
  bool user_mode_only = false;
  /// One sentence for each reason why events are missing; empty: all were counted.
  std::string absence;
};

/// Counts what the programs do that this thread starts, from their exec to their end, all their
/// threads and programs of their own included: cycles, instructions, caches, branches, page faults,
/// context switches and moves between processors, as far as the system counts them (Linux'
/// perf_event). What it does not count is told in words and is no error. Programs that are started
/// do not inherit the descriptors.
///
/// Thread rule: construct it on the thread that starts the programs; read() anywhere, once they
/// have been waited for.
class HardwareCounters {
 public:
  /// Opens a counter that `event` adds to: a descriptor, or −errno. `with_kernel`: also what the
  /// kernel does for the program.
  using Opener = std::function<int(const CountedEvent& event, bool with_kernel)>;

  explicit HardwareCounters(const Opener& open = open_for_programs);
  HardwareCounters(const HardwareCounters&) = delete;
  HardwareCounters& operator=(const HardwareCounters&) = delete;
  ~HardwareCounters();

  /// Since construction.
  [[nodiscard]] EventCounts read() const;

 private:
  struct Counter {
    std::string_view name;
    int descriptor = -1;
  };
  /// Events that are missing for one reason.
  struct Gap {
    std::string reason;
    std::vector<std::string_view> events;
  };

  static int open_for_programs(const CountedEvent& event, bool with_kernel);
  static void add_gap(std::vector<Gap>& gaps, std::string_view event, std::string reason);
  void open_event(const CountedEvent& event, const Opener& open);

  std::vector<Counter> counters_;
  std::vector<Gap> gaps_;
  bool user_mode_only_ = false;
};

}  // namespace vantage::scheduler
