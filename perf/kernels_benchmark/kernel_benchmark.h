#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "engine/column_work.h"

namespace vantage::perf {

/// Work of a kernel per cell (candidate disparity of a pixel) or pixel: operations as in
/// kernels/kernel_work.h, bytes loaded from and stored to rows. 0: not counted.
struct UnitWork {
  double operations = 0;
  double bytes = 0;
};

/// One kernel with its own data, small enough for the level 1 cache.
struct KernelBenchmark {
  std::string name;
  std::string_view unit;      ///< "cell" or "pixel"
  double units_per_call = 1;  ///< units processed per call
  UnitWork work;              ///< per unit
  /// Creates the data, for the instruction set in use, and returns the call.
  std::function<std::function<void()>()> prepare;
  bool has_vectors = true;  ///< false: scalar code, the same on all instruction sets
};
using KernelBenchmarks = std::vector<KernelBenchmark>;

KernelBenchmarks cost_kernels();
KernelBenchmarks sum_kernels();
KernelBenchmarks selection_kernels();
KernelBenchmarks iteration_kernels();
KernelBenchmarks level_kernels();
KernelBenchmarks view_kernels();
KernelBenchmarks refinement_kernels();

/// Work per cell, from the table in kernels/kernel_work.h.
inline UnitWork per_cell(const kernels::KernelWork& work, int candidates) {
  const scheduler::ColumnWork column = column_work(work, candidates);
  return {column.operations / column.cells, column.bytes / column.cells};
}
/// Work per pixel, for kernels whose work is all per column.
inline UnitWork per_column(const kernels::KernelWork& work) {
  constexpr double kValueBytes = 4;
  return {work.operations_per_column, kValueBytes * work.values_per_column};
}

/// `size` values aligned to a cache line, followed by a few more readable values.
template <typename T>
class AlignedValues {
 public:
  explicit AlignedValues(std::size_t size) : memory_(size + kSpare) {}
  /// Integers in [0, limit) times `unit`, the same in every run.
  AlignedValues(std::size_t size, unsigned limit, T unit, unsigned seed = 1) : AlignedValues(size) {
    std::mt19937 random(seed);
    for (T& value : memory_) {
      value = static_cast<T>(static_cast<T>(random() % limit) * unit);
    }
  }
  [[nodiscard]] T* data() {
    const auto address = reinterpret_cast<std::uintptr_t>(memory_.data());
    return memory_.data() + (kLine - address % kLine) % kLine / sizeof(T);
  }

 private:
  static constexpr std::size_t kLine = 64;
  static constexpr std::size_t kSpare = 2 * kLine;
  std::vector<T> memory_;
};

/// A benchmark of `call` on its own `Data`, created again for each instruction set.
template <class Data, class Call>
KernelBenchmark on_own_data(std::string name, std::string_view unit, double units_per_call,
                            UnitWork work, Call call) {
  return {std::move(name), unit, units_per_call, work,
          [call] { return [call, data = std::make_shared<Data>()] { call(*data); }; }};
}

}  // namespace vantage::perf
