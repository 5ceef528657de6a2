// Google Benchmark of kernels, once per instruction set of this machine, with the data in the level
// 1 cache: ns per cell or pixel, operations and bytes per second, and the fraction of the
// instruction set's peak (`of_roof`: its roofline, measured beforehand). The label names the part
// of the roof that limits the kernel.

#include <benchmark/benchmark.h>
#include <time.h>

#include <functional>
#include <string>

#include "kernels/simd_target.h"
#include "perf/kernels_benchmark/kernel_benchmark.h"
#include "perf/kernels_benchmark/roofline.h"

namespace vantage::perf {
namespace {

/// Processor time of this process: other load affects it less than the wall clock.
double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

void run(benchmark::State& state, long long target, const KernelBenchmark& kernel) {
  kernels::force_target(target);
  const CoreCeilings& ceilings = ceilings_of(kernels::target_in_use());
  const std::function<void()> call = kernel.prepare();
  const double begin_s = processor_seconds();
  for (auto _ : state) {
    call();
    benchmark::ClobberMemory();
  }
  const double units = kernel.units_per_call * static_cast<double>(state.iterations());
  const double unit_ns = 1e9 * (processor_seconds() - begin_s) / units;
  const UnitWork& work = kernel.work;
  state.counters["ns/" + std::string(kernel.unit)] = unit_ns;
  if (work.operations > 0) {
    state.counters["GFLOP/s"] = work.operations / unit_ns;
  }
  if (work.bytes > 0) {
    state.counters["GB/s"] = work.bytes / unit_ns;
    state.counters["of_roof"] = 1e9 * min_seconds(work, ceilings) / unit_ns;
    state.SetLabel(is_bound_by_arithmetic(work, ceilings) ? "arithmetic" : "loads and stores");
  }
  kernels::force_target(0);
}

/// Reports the roof itself beside the other results.
void show_ceilings(benchmark::State& state, long long target) {
  kernels::force_target(target);
  const CoreCeilings& ceilings = ceilings_of(target);
  for (auto _ : state) {
  }
  state.counters["GFLOP/s"] = 1e-9 * ceilings.operations_per_s;
  state.counters["GB/s"] = 1e-9 * ceilings.bytes_per_s;
  kernels::force_target(0);
}

void register_all() {
  const long long available = kernels::available_targets();
  const auto for_each_target = [available](const auto& body) {
    for (int bit = 0; bit < 63; ++bit) {
      if (const long long target = 1LL << bit; (available & target) != 0) {
        body(target, "/" + std::string(kernels::target_name(target)));
      }
    }
  };
  for_each_target([](long long target, const std::string& suffix) {
    benchmark::RegisterBenchmark(("ceiling" + suffix).c_str(), [target](benchmark::State& state) {
      show_ceilings(state, target);
    })->Iterations(1);
  });
  for (const auto& family : {cost_kernels, sum_kernels, selection_kernels, iteration_kernels,
                             level_kernels, view_kernels, refinement_kernels}) {
    for (const KernelBenchmark& kernel : family()) {
      const auto add = [&kernel](long long target, const std::string& suffix) {
        benchmark::RegisterBenchmark(
            (kernel.name + suffix).c_str(),
            [target, kernel](benchmark::State& state) { run(state, target, kernel); });
      };
      if (kernel.has_vectors) {
        for_each_target(add);
      } else {
        add(0, "/plain");
      }
    }
  }
}

}  // namespace
}  // namespace vantage::perf

int main(int argc, char** argv) {
  vantage::perf::register_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 2;
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
