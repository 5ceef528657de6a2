#include "perf/kernels_benchmark/roofline.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <map>

#include "kernels/machine_ceiling/machine_ceiling.h"

namespace vantage::perf {
namespace {

/// Maximum rate that work() reports, over 60 ms: other load can only reduce it.
template <class Work>
double best_rate(const Work& work) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end = Clock::now() + std::chrono::milliseconds(60);
  double best = 0;
  Clock::time_point before = Clock::now();
  while (before < end) {
    const double done = work();
    const Clock::time_point after = Clock::now();
    best = std::max(best, done / std::chrono::duration<double>(after - before).count());
    before = after;
  }
  return best;
}

CoreCeilings measure() {
  constexpr std::size_t kFloats = 2048;  // three arrays of 8 KiB
  constexpr int kRepetitions = 512;
  AlignedValues<float> a(kFloats);
  AlignedValues<float> b(kFloats, 256, 1.0F);
  AlignedValues<float> c(kFloats, 256, 1.0F);
  float sink = 0;
  const double triad = best_rate([&] {
    for (int k = 0; k < kRepetitions; ++k) {
      kernels::triad(a.data(), b.data(), c.data(), 0.5F, kFloats);
    }
    return 3.0 * kFloats * sizeof(float) * kRepetitions;
  });
  const double loads = best_rate([&] {
    for (int k = 0; k < kRepetitions; ++k) {
      sink += kernels::load_all(b.data(), kFloats);
    }
    return 1.0 * kFloats * sizeof(float) * kRepetitions;
  });
  const double operations = best_rate([&] {
    constexpr std::int64_t kRounds = 4000;
    return kernels::multiply_and_add(kRounds, sink);
  });
  return {operations, std::max(triad, loads)};
}

}  // namespace

const CoreCeilings& ceilings_of(long long target) {
  static std::map<long long, CoreCeilings> known;
  const auto place = known.find(target);
  return place != known.end() ? place->second : known.emplace(target, measure()).first->second;
}

double min_seconds(const UnitWork& work, const CoreCeilings& ceilings) {
  return std::max(work.operations / ceilings.operations_per_s, work.bytes / ceilings.bytes_per_s);
}

bool is_bound_by_arithmetic(const UnitWork& work, const CoreCeilings& ceilings) {
  return work.operations / ceilings.operations_per_s > work.bytes / ceilings.bytes_per_s;
}

}  // namespace vantage::perf
