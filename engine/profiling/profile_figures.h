#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/profiling/profile.h"

namespace vantage {

// Thread rule of all: pure.

/// Median (of an even number: the mean of the two in the middle), least and most of `values`; zeros
/// without any.
ProfileSample sample_of(std::vector<double> values);

/// Wall times of one number of threads, in seconds, by round.
struct WallTimes {
  int threads = 1;
  std::vector<double> wall_s;
};

/// Karp and Flatt's experimentally determined serial fraction of `speed_up` (> 0) on `processors`
/// (> 1) times as many threads: (1/ψ − 1/p) / (1 − 1/p). Below 0 where more threads help more than
/// there are of them.
double karp_flatt(double speed_up, double processors);

/// How much faster each is than the first, in the same order. Ratios are those of one round, so
/// that a machine that slows down does so for both. All have as many rounds.
std::vector<SpeedUp> speed_ups(std::span<const WallTimes> times);

/// The serial fraction s with which Amdahl's law, 1/ψ = s + (1 − s)/p, is nearest to the medians by
/// least squares in 1/ψ; p counts threads by those of the first. None with fewer than two numbers
/// of threads.
std::optional<double> amdahl_fit(std::span<const SpeedUp> speed_ups);

/// Processor time of all stages, in seconds.
double stages_s(const ThreadCountProfile& count);
/// Work of the pool's threads in the run with the median wall time; 0 if it is not known.
double pool_work_s(const ThreadCountProfile& count);
/// Their work and waits.
double pool_time_s(const ThreadCountProfile& count);

/// None where instructions or cycles were not counted.
std::optional<double> instructions_per_cycle(const HardwareCounts& hardware);

}  // namespace vantage
