#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/profiling/machine_ceilings.h"

namespace vantage {

/// A figure over the runs of a profile.
struct ProfileSample {
  double median = 0;
  double least = 0;
  double most = 0;

  bool operator==(const ProfileSample&) const = default;
};

/// What the stages of one name did in one run, summed over all threads, passes, strips and frames.
/// Medians over the runs where they vary. 0 cells: it does not know its work.
struct StageProfile {
  std::string name;
  ProfileSample seconds;   ///< of processor time
  double columns = 0;      ///< made
  double own_columns = 0;  ///< of them, those that are results and no halo or repetition
  double cells = 0;
  double operations = 0;
  double bytes = 0;  ///< loaded and stored by the kernel, whichever cache they lie in

  bool operator==(const StageProfile&) const = default;
};

/// A named part of the work, or of the waiting. Stages of chains are within the parts that sweep
/// them ("match left").
struct PartProfile {
  std::string name;
  ProfileSample seconds;  ///< over all threads, without the parts within it
  double count = 0;       ///< of spans

  bool operator==(const PartProfile&) const = default;
};

struct ThreadProfile {
  std::string name;
  bool is_in_pool = false;
  double work_s = 0;
  double wait_s = 0;

  bool operator==(const ThreadProfile&) const = default;
};

/// What the waiting threads of the pool waited for, in seconds over all of them; see
/// waiting_causes().
struct WaitingProfile {
  ProfileSample reading_s;    ///< frames or images being read or decoded
  ProfileSample computing_s;  ///< other work
  ProfileSample writing_s;    ///< results being encoded or written
  ProfileSample nothing_s;    ///< no thread did anything that is recorded

  bool operator==(const WaitingProfile&) const = default;
};

/// One thread doing one thing, for drawing: the innermost of what was recorded.
struct TimelineSpan {
  std::string name;
  bool is_wait = false;
  double begin_s = 0;
  double end_s = 0;
  int frame = -1;  ///< −1: about none

  bool operator==(const TimelineSpan&) const = default;
};

/// A thread's row in the timeline. Spans that are too short to be seen are joined with neighbours
/// of their kind.
struct TimelineRow {
  std::string thread;
  bool is_in_pool = false;
  std::vector<TimelineSpan> spans;  ///< in order, apart

  bool operator==(const TimelineRow&) const = default;
};

/// What was measured on one number of threads.
struct ThreadCountProfile {
  int threads = 1;
  int runs = 0;
  ProfileSample wall_s;     ///< of the whole command
  ProfileSample compute_s;  ///< without reading and writing files, as --report tells
  ProfileSample cells_per_s;
  ProfileSample frames_per_s;  ///< 0 for one pair
  ProfileSample work_share;    ///< of the pool's time, 0..1
  ProfileSample peak_memory_bytes;
  /// Greatest ÷ mean work of a thread of the pool, ≥ 1.
  ProfileSample imbalance;
  std::vector<StageProfile> stages;    ///< most time first
  std::vector<PartProfile> parts;      ///< most time first
  std::vector<PartProfile> waits;      ///< most time first
  WaitingProfile waiting_for;          ///< the same time as in waits, by cause
  std::vector<ThreadProfile> workers;  ///< of the run with the median wall time

  bool operator==(const ThreadCountProfile&) const = default;
};

/// How much faster more threads are.
struct SpeedUp {
  int threads = 1;
  ProfileSample ratio;  ///< wall time of the fewest threads ÷ that of these, run by run
  double efficiency = 0;
  /// Karp and Flatt's serial fraction; none for the fewest threads.
  std::optional<double> serial_fraction;

  bool operator==(const SpeedUp&) const = default;
};

/// What the memory belonged to at its peak, or as much of it as is known.
struct MemoryOwner {
  std::string name;
  std::uint64_t bytes = 0;

  bool operator==(const MemoryOwner&) const = default;
};

/// Counts of the processor over one run, all threads. Empty where the system keeps none.
struct HardwareCounts {
  std::map<std::string, ProfileSample> counts;  ///< "instructions", "cycles", …
  std::string absence;                          ///< why there are none or not all; empty: all there

  bool operator==(const HardwareCounts&) const = default;
};

/// What `vantage profile` has found out.
struct Profile {
  std::string version;
  std::string command;  ///< as it would be typed
  std::string date;     ///< ISO 8601, UTC
  std::string processor;
  std::string isa;
  int hardware_threads = 1;
  std::uint64_t peak_memory_bytes = 0;  ///< the most of the runs on the most threads
  /// For each number of threads that was measured, in that order.
  std::vector<MachineCeilings> ceilings;
  std::vector<ThreadCountProfile> thread_counts;  ///< fewest first
  /// What the user can do about the time, most first (profile_advice); none in a profile that was
  /// read from a file.
  std::vector<std::string> advice = {};
  std::vector<SpeedUp> speed_ups;
  /// Least-squares fit of Amdahl's law to speed_ups; none with a single number of threads.
  std::optional<double> serial_fraction;
  std::vector<TimelineRow> timeline;  ///< of the most threads, run with the median wall time
  double timeline_s = 0;              ///< its wall time
  std::vector<MemoryOwner> memory;    ///< most first
  HardwareCounts hardware;            ///< of the most threads

  bool operator==(const Profile&) const = default;
};

}  // namespace vantage
