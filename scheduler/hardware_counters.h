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
  /// Counted in user mode only if the kernel's part is not accessible; false: the event happens in
  /// the kernel only.
  bool counts_in_user_mode = true;
};

/// Counts of events.
struct EventCounts {
  struct Count {
    std::string_view name;
    double events = 0;  ///< estimated if counters were multiplexed
  };
  std::vector<Count> counts;
  /// The kernel's part could not be counted.
  bool user_mode_only = false;
  /// One sentence for each reason why events are missing; empty: all were counted.
  std::string absence;
};

/// Counts events of the programs that this thread starts, from exec to exit, including their
/// threads and child programs: cycles, instructions, caches, branches, page faults, context
/// switches and migrations between processors, as far as the system counts them (perf_event).
/// Events that cannot be counted are listed in EventCounts::absence and are no error. Programs that
/// are started do not inherit the descriptors.
///
/// Thread rule: construct it on the thread that starts the programs; read() on any thread, after
/// the programs have been waited for.
class HardwareCounters {
 public:
  /// Opens a counter of `event` and returns a descriptor, or −errno. `with_kernel`: also count
  /// events in the kernel on behalf of the program.
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
  /// Events that are missing for the same reason.
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
