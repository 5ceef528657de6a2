// Sums over windows: integer running sums down columns and along rows, weighted float sums.

#include <array>
#include <utility>

#include "kernels/candidates.h"
#include "kernels/cell_smoothing/cell_smoothing.h"
#include "kernels/column_ssd/column_ssd.h"
#include "kernels/column_sum/column_sum.h"
#include "kernels/row_sum/row_sum.h"
#include "perf/kernels_benchmark/kernel_benchmark.h"

namespace vantage::perf {
namespace {

constexpr int kLanes = 64;

struct SquaredDifferences {
  static constexpr int kColumns = 64;
  static constexpr double kCells = kColumns * kLanes;
  static constexpr int kPixels = 512;
  AlignedValues<std::uint8_t> entering{kPixels, 256, 1, 1};
  AlignedValues<std::uint8_t> leaving{kPixels, 256, 1, 2};
  AlignedValues<float> entering_float{2 * kPixels, 256, 1.0F, 1};
  AlignedValues<float> leaving_float{2 * kPixels, 256, 1.0F, 2};
  AlignedValues<std::int32_t> reference_pairs{kPixels};
  AlignedValues<std::int32_t> partner_pairs{kPixels};
  AlignedValues<std::int32_t> sums{kColumns * kLanes};

  SquaredDifferences() {
    interleave();
    kernels::interleave_rows(leaving.data(), entering.data(), 3, kPixels, partner_pairs.data());
  }
  void interleave() {
    kernels::interleave_rows(entering.data(), leaving.data(), 3, kPixels, reference_pairs.data());
  }
  void of_8_bit() {
    kernels::column_ssd_row(
        kernels::ColumnSsdPairs{reference_pairs.data(), partner_pairs.data() + kColumns, -1,
                                kColumns, kLanes},
        sums.data(), sums.data());
  }
  void of_float() {
    kernels::column_ssd_row(
        kernels::ColumnSsdFloat{entering_float.data(), leaving_float.data(),
                                leaving_float.data() + kPixels + kColumns,
                                entering_float.data() + kPixels + kColumns, -1, kColumns, kLanes},
        sums.data(), sums.data());
  }
};

struct Costs {
  static constexpr int kCount = 32 * kLanes;
  AlignedValues<float> entering{kCount, 4096, 1.0F, 1};
  AlignedValues<float> leaving{kCount, 4096, 1.0F, 2};
  AlignedValues<std::int32_t> sums{kCount};

  void add() {
    kernels::column_sum_row({entering.data(), leaving.data(), 0, 16, kCount}, sums.data(),
                            sums.data());
  }
};

/// Sums over windows of 9 columns.
struct AlongRows {
  static constexpr int kColumns = 48;
  static constexpr double kCells = kColumns * kLanes;
  static constexpr int kRadius = 4;
  static constexpr int kInputColumns = kColumns + 2 * kRadius;
  AlignedValues<std::int32_t> input{kInputColumns * kLanes, 1000, 64};
  AlignedValues<std::int32_t> sums{kColumns * kLanes};
  AlignedValues<std::int32_t> min{kColumns};
  AlignedValues<std::int32_t> work{kColumns * kernels::kLaneMultiple};

  /// Sums and the minimum of each column, with or without storing the sums.
  void add(bool minima, bool store) {
    kernels::RowSum row;
    row.input = input.data();
    row.input_end = kInputColumns;
    row.output_begin = kRadius;
    row.output_end = kRadius + kColumns;
    row.radius = kRadius;
    row.lanes = kLanes;
    row.number_lanes = true;
    row.output = store ? sums.data() : nullptr;
    if (minima) {
      row.minima = min.data();
      row.minima_work = work.data();
      row.candidates = kLanes;
    }
    kernels::row_sum(row);
  }
};

/// A Gaussian of σ = 2 over 13 rows.
struct Gaussian {
  static constexpr int kRadius = 6;
  static constexpr int kCount = 8 * kLanes;
  AlignedValues<float> rows{(2 * kRadius + 1) * kCount, 256, 1.0F};
  AlignedValues<float> output{kCount};
  std::array<const float*, 2 * kRadius + 1> runs{};
  std::array<float, kRadius + 1> weights{0.2F, 0.18F, 0.12F, 0.065F, 0.027F, 0.009F, 0.002F};

  Gaussian() {
    for (std::size_t k = 0; k < runs.size(); ++k) {
      runs[k] = rows.data() + k * kCount;
    }
  }
  void add() {
    kernels::symmetric_sum({runs.data(), weights.data(), kRadius, kCount}, output.data());
  }
};

struct Cascade {
  static constexpr int kRadius = kernels::BoxCascade::kRadius;
  static constexpr int kColumns = 32;
  static constexpr int kInputColumns = kColumns + 2 * kRadius;
  static constexpr int kLanesHere = 16;
  AlignedValues<float> cells{(2 * kRadius + 1) * kInputColumns * kLanesHere, 256, 1.0F};
  AlignedValues<float> work{kInputColumns * kLanesHere};
  AlignedValues<float> output{kColumns * kLanesHere};
  std::array<const float*, 2 * kRadius + 1> rows{};

  Cascade() {
    for (std::size_t k = 0; k < rows.size(); ++k) {
      rows[k] = cells.data() + k * kInputColumns * kLanesHere;
    }
  }
  void add() {
    kernels::box_cascade_row(
        {rows.data(), 0, kInputColumns, kRadius, kRadius + kColumns, kLanesHere}, work.data(),
        output.data());
  }
};

}  // namespace

KernelBenchmarks sum_kernels() {
  const auto row_sum = [](std::string name, bool minima, bool store) {
    return on_own_data<AlongRows>(std::move(name), "cell", AlongRows::kCells,
                                  per_cell(kernels::row_sum_work(store), kLanes),
                                  [minima, store](AlongRows& d) { d.add(minima, store); });
  };
  return {
      on_own_data<SquaredDifferences>("interleave_rows", "pixel", SquaredDifferences::kPixels,
                                      {0, 6}, [](SquaredDifferences& d) { d.interleave(); }),
      on_own_data<SquaredDifferences>("column_ssd_row/8-bit", "cell", SquaredDifferences::kCells,
                                      per_cell(kernels::kColumnSsdPairsWork, kLanes),
                                      [](SquaredDifferences& d) { d.of_8_bit(); }),
      on_own_data<SquaredDifferences>("column_ssd_row/float", "cell", SquaredDifferences::kCells,
                                      per_cell(kernels::kColumnSsdFloatWork, kLanes),
                                      [](SquaredDifferences& d) { d.of_float(); }),
      on_own_data<Costs>("column_sum_row", "cell", Costs::kCount,
                         per_cell(kernels::kColumnSumWork, kLanes), [](Costs& d) { d.add(); }),
      row_sum("row_sum/sums", false, true),
      row_sum("row_sum/minima", true, false),
      row_sum("row_sum/both", true, true),
      on_own_data<Gaussian>("symmetric_sum/13 rows", "cell", Gaussian::kCount,
                            per_cell(kernels::symmetric_sum_work(Gaussian::kRadius), kLanes),
                            [](Gaussian& d) { d.add(); }),
      on_own_data<Cascade>("box_cascade_row", "cell", Cascade::kColumns * Cascade::kLanesHere,
                           per_cell(kernels::kBoxCascadeWork, Cascade::kLanesHere),
                           [](Cascade& d) { d.add(); }),
  };
}

}  // namespace vantage::perf
