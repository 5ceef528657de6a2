#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/profiling/machine_ceilings.h"

namespace vantage {

/// A figure over the runs of a profile.
struct ProfileSample {
  double median = 0;
  double min = 0;
  double max = 0;
};

/// Work of the stages of one name in one run, summed over all threads, passes, strips and frames.
/// Medians over the runs where they vary. 0 cells: the stage does not report its work.
struct StageProfile {
  std::string name;
  ProfileSample seconds;   ///< of processor time
  double columns = 0;      ///< computed
  double own_columns = 0;  ///< of these, results: without halo and repetition
  double cells = 0;
  double operations = 0;
  double bytes = 0;  ///< loaded and stored by the kernel, from any cache level
};

/// A named part of the work, or of the waiting. Stages of chains are inside the parts that sweep
/// them ("match left").
struct PartProfile {
  std::string name;
  ProfileSample seconds;           ///< over all threads, excluding nested parts
  double count = 0;                ///< number of spans
  ProfileSample processor_s = {};  ///< of the seconds, those in which the threads ran
};

struct ThreadProfile {
  std::string name;
  bool is_in_pool = false;
  double work_s = 0;
  double wait_s = 0;
};

/// Causes of waiting of the pool's threads, in seconds over all of them; see waiting_causes().
struct WaitingProfile {
  ProfileSample reading_s;    ///< reading or decoding of frames or images
  ProfileSample computing_s;  ///< other work
  ProfileSample writing_s;    ///< encoding or writing of results
  ProfileSample nothing_s;    ///< no thread was doing anything recorded
};

/// One activity of one thread, for drawing: the innermost recorded span.
struct TimelineSpan {
  std::string name;
  bool is_wait = false;
  double begin_s = 0;
  double end_s = 0;
  int frame = -1;  ///< −1: none
};

/// A thread's row in the timeline. Spans too short to be visible are merged with neighbours of
/// their kind.
struct TimelineRow {
  std::string thread;
  bool is_in_pool = false;
  std::vector<TimelineSpan> spans;  ///< in order, disjoint
};

/// Measurements on one number of threads.
struct ThreadCountProfile {
  int threads = 1;
  int runs = 0;
  ProfileSample wall_s;     ///< of the whole command
  ProfileSample compute_s;  ///< without reading and writing files, as reported by --report
  ProfileSample cells_per_s;
  ProfileSample frames_per_s;  ///< 0 for one pair
  ProfileSample work_share;    ///< of the pool's time, 0..1
  ProfileSample peak_memory_bytes;
  /// Maximum ÷ mean work of a thread of the pool, ≥ 1.
  ProfileSample imbalance;
  double frames = 1;
  std::vector<PartProfile> frame_steps;  ///< of a run, longest first: processor time alone
  std::vector<StageProfile> stages;      ///< longest first
  std::vector<PartProfile> parts;        ///< longest first
  std::vector<PartProfile> waits;        ///< longest first
  WaitingProfile waiting_for;            ///< the same time as in waits, by cause
  std::vector<ThreadProfile> workers;    ///< of the run with the median wall time
};

/// Speed-up by more threads.
struct SpeedUp {
  int threads = 1;
  ProfileSample ratio;  ///< wall time on the fewest threads ÷ that on these, run by run
  double efficiency = 0;
  /// Karp and Flatt's serial fraction; empty for the fewest threads.
  std::optional<double> serial_fraction;
};

/// Owners of the memory at its peak, as far as known.
struct MemoryOwner {
  std::string name;
  std::uint64_t bytes = 0;
};

/// Result of `vantage profile`.
struct Profile {
  std::string version;
  std::string command;  ///< as typed
  std::string date;     ///< ISO 8601, UTC
  std::string processor;
  std::string isa;
  int hardware_threads = 1;
  std::uint64_t peak_memory_bytes = 0;  ///< maximum over the runs on the largest thread count
  /// For each measured number of threads, in that order.
  std::vector<MachineCeilings> ceilings;
  std::vector<ThreadCountProfile> thread_counts;  ///< fewest first
  /// Advice to the user about the time, largest saving first (profile_advice); empty in a profile
  /// read from a file.
  std::vector<std::string> advice = {};
  std::vector<SpeedUp> speed_ups;
  /// Least-squares fit of Amdahl's law to speed_ups; empty with a single number of threads.
  std::optional<double> serial_fraction;
  std::vector<TimelineRow> timeline;  ///< largest thread count, run with the median wall time
  double timeline_s = 0;              ///< its wall time
  std::vector<MemoryOwner> memory;    ///< largest first
};

}  // namespace vantage
