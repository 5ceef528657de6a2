#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/profiling/profile.h"

namespace vantage {

// Thread rule of all: pure.

/// Median (of an even number: the mean of the two in the middle), minimum and maximum of `values`;
/// zeros if empty.
ProfileSample sample_of(std::vector<double> values);

/// Wall times of one number of threads, in seconds, by round.
struct WallTimes {
  int threads = 1;
  std::vector<double> wall_s;
};

/// Karp and Flatt's experimentally determined serial fraction of `speed_up` (> 0) on `processors`
/// (> 1) times as many threads: (1/ψ − 1/p) / (1 − 1/p). Negative for superlinear speed-up.
double karp_flatt(double speed_up, double processors);

/// Speed-up of each relative to the first, in the same order. Ratios are taken within a round, so
/// that changes in the machine's speed affect both. All have the same number of rounds.
std::vector<SpeedUp> speed_ups(std::span<const WallTimes> times);

/// The serial fraction s of Amdahl's law, 1/ψ = s + (1 − s)/p, fitted to the medians by least
/// squares in 1/ψ; p is the number of threads relative to the first. Empty with fewer than two
/// numbers of threads.
std::optional<double> amdahl_fit(std::span<const SpeedUp> speed_ups);

/// Processor time that a frame, or the pair, takes in a step of frames, a part of the work or a
/// stage of matching (which is timed by the clock: more threads than processors lengthen it).
struct ProcessorGrowth {
  std::string name;
  std::string kind;            ///< "step", "part", "stage"
  std::vector<double> ms;      ///< milliseconds, by Profile::thread_counts
  std::vector<double> growth;  ///< against the fewest threads, 0.1 being a tenth more
};

/// All steps, and what else takes a two-hundredth of the work; each kind longest first, each name
/// once.
std::vector<ProcessorGrowth> processor_growth(const Profile& profile);

/// Processor time of all stages, in seconds.
double stages_s(const ThreadCountProfile& count);
/// Work of the pool's threads in the run with the median wall time; 0 if unknown.
double pool_work_s(const ThreadCountProfile& count);
/// Their work and waits.
double pool_time_s(const ThreadCountProfile& count);

}  // namespace vantage
