#include "engine/profiling/machine_ceilings.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "engine/seconds_since.h"
#include "kernels/machine_ceiling/machine_ceiling.h"

namespace vantage {
namespace {

using Clock = std::chrono::steady_clock;

/// Does its work once and returns the amount.
using Work = std::function<double(int thread)>;

/// The highest rate of `threads` concurrent threads observed within `seconds`.
double best_rate(Execution& execution, int threads, double seconds, const Work& work) {
  double best = 0;
  const Clock::time_point begin = Clock::now();
  do {
    std::vector<double> done(static_cast<std::size_t>(threads));
    std::atomic<int> arrived{0};
    const Clock::time_point start = Clock::now();
    execution.executor().parallel_for(threads, [&](int task) {
      // The first threads wait for the others, but only for a while: their arrival is not
      // guaranteed.
      arrived.fetch_add(1);
      const Clock::time_point arrival = Clock::now();
      while (arrived.load() < threads && seconds_since(arrival) < 1e-3) {
      }
      done[static_cast<std::size_t>(task)] = work(task);
    });
    const double took = seconds_since(start);
    double sum = 0;
    for (const double one : done) {
      sum += one;
    }
    best = std::max(best, sum / took);
  } while (seconds_since(begin) < seconds);
  return best;
}

}  // namespace

MachineCeilings measure_ceilings(Execution& execution, double seconds) {
  constexpr std::size_t kMaxMemoryBytes = std::size_t{64} << 20U;  // per thread and array
  const scheduler::Machine& machine = execution.machine();
  const int threads = execution.executor().thread_count();
  const auto all = static_cast<std::size_t>(threads);

  // Loads come from level 2 when the values fill half of it; the triad uses memory when its arrays
  // are several times the size of the last-level cache.
  const std::size_t l2_floats = std::max<std::size_t>(machine.l2_bytes / 2, 64) / sizeof(float);
  const std::size_t last_cache = std::max(machine.l3_bytes, machine.l2_bytes * all);
  const std::size_t memory_floats =
      std::min(kMaxMemoryBytes, std::max<std::size_t>(2 * last_cache, 1U << 20U)) / sizeof(float);
  struct Arrays {
    std::vector<float> a, b, c, near;
    float sink = 0;
  };
  std::vector<Arrays> arrays(all);
  // Filled by the threads that use them, so that the memory is local to them.
  execution.executor().parallel_for(threads, [&](int thread) {
    Arrays& own = arrays[static_cast<std::size_t>(thread)];
    own.a.assign(memory_floats, 0);
    own.b.assign(memory_floats, 1);
    own.c.assign(memory_floats, 2);
    own.near.assign(l2_floats, 1);
  });
  const Work compute = [&](int thread) {
    constexpr std::int64_t kRounds = 20'000;  // about a millisecond
    return kernels::multiply_and_add(kRounds, arrays[static_cast<std::size_t>(thread)].sink);
  };
  const Work load = [&](int thread) {
    constexpr int kRepetitions = 64;
    Arrays& own = arrays[static_cast<std::size_t>(thread)];
    for (int k = 0; k < kRepetitions; ++k) {
      own.sink += kernels::load_all(own.near.data(), l2_floats);
    }
    return static_cast<double>(l2_floats * sizeof(float)) * kRepetitions;
  };
  const Work stream = [&](int thread) {
    Arrays& own = arrays[static_cast<std::size_t>(thread)];
    kernels::triad(own.a.data(), own.b.data(), own.c.data(), 0.5F, memory_floats);
    return 3.0 * static_cast<double>(memory_floats * sizeof(float));
  };

  const double each = seconds / 6;
  MachineCeilings ceilings;
  ceilings.threads = threads;
  ceilings.core_gflops = best_rate(execution, 1, each, compute) * 1e-9;
  ceilings.all_gflops = best_rate(execution, threads, each, compute) * 1e-9;
  ceilings.core_l2_gb_per_s = best_rate(execution, 1, each, load) * 1e-9;
  ceilings.all_l2_gb_per_s = best_rate(execution, threads, each, load) * 1e-9;
  ceilings.core_memory_gb_per_s = best_rate(execution, 1, each, stream) * 1e-9;
  ceilings.all_memory_gb_per_s = best_rate(execution, threads, each, stream) * 1e-9;
  return ceilings;
}

}  // namespace vantage
