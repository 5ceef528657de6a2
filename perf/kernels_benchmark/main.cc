// Google Benchmark of kernels, once per instruction set this machine has, with the data in the
// level-1 cache: ns per cell or pixel, operations and bytes per second, and the share of what the
// instruction set could do at best (`of_roof`: its roofline, measured before). The label says which
// part of the roof is above the kernel.

#include <benchmark/benchmark.h>

#include <functional>
#include <string>

#include "kernels/simd_target.h"
#include "perf/kernels_benchmark/kernel_benchmark.h"
#include "perf/kernels_benchmark/roofline.h"

namespace vantage::perf {
namespace {

using benchmark::Counter;

void count_work(benchmark::State& state, const KernelBenchmark& kernel,
                const CoreCeilings& ceilings) {
  constexpr auto kRate = Counter::kIsIterationInvariantRate;
  const double units = kernel.units_per_call;
  // Inverted: seconds per 10⁻⁹ units.
  state.counters["ns/" + std::string(kernel.unit)] =
      Counter(1e-9 * units, kRate | Counter::kInvert);
  if (kernel.work.operations > 0) {
    state.counters["GFLOP/s"] = Counter(1e-9 * units * kernel.work.operations, kRate);
  }
  if (kernel.work.bytes > 0) {
    state.counters["GB/s"] = Counter(1e-9 * units * kernel.work.bytes, kRate);
    state.counters["of_roof"] = Counter(units * least_seconds(kernel.work, ceilings), kRate);
    state.SetLabel(is_bound_by_arithmetic(kernel.work, ceilings) ? "arithmetic"
                                                                 : "loads and stores");
  }
}

void run(benchmark::State& state, long long target, const KernelBenchmark& kernel) {
  kernels::force_target(target);
  const CoreCeilings& ceilings = ceilings_of(kernels::target_in_use());
  const std::function<void()> call = kernel.prepare();
  for (auto _ : state) {
    call();
    benchmark::ClobberMemory();
  }
  count_work(state, kernel, ceilings);
  kernels::force_target(0);
}

/// The roof itself, as figures beside the others.
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
                             view_kernels, refinement_kernels}) {
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
