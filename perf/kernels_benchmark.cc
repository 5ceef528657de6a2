// Google Benchmark of the matching kernels, once per instruction set this machine has, with the
// data in the level-1 cache: a strip of 64 columns and 64 disparities.
// Figures per cell: "items" are cells.

#include <benchmark/benchmark.h>

#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "kernels/candidates.h"
#include "kernels/cell_winner/cell_winner.h"
#include "kernels/column_ssd/column_ssd.h"
#include "kernels/mean_energy/mean_energy.h"
#include "kernels/parabola/parabola.h"
#include "kernels/row_sum/row_sum.h"
#include "kernels/simd_target.h"
#include "kernels/winner/winner.h"

namespace vantage::kernels {
namespace {

constexpr int kColumns = 64;
constexpr int kLanes = 64;
constexpr int kRadius = 4;
constexpr int kInputColumns = kColumns + 2 * kRadius;
constexpr int kIndexBits = 6;

struct Rows {
  std::vector<std::uint8_t> entering = random_pixels<std::uint8_t>();
  std::vector<std::uint8_t> leaving = random_pixels<std::uint8_t>();
  std::vector<float> entering_float = random_pixels<float>();
  std::vector<float> leaving_float = random_pixels<float>();
  std::vector<std::int32_t> reference_pairs = std::vector<std::int32_t>(kPixels);
  std::vector<std::int32_t> partner_pairs = std::vector<std::int32_t>(kPixels);
  std::vector<std::int32_t> column_sums = std::vector<std::int32_t>(kInputColumns * kLanes);
  std::vector<std::int32_t> sums = std::vector<std::int32_t>(kColumns * kLanes);
  std::vector<std::int32_t> least = std::vector<std::int32_t>(kColumns);
  std::vector<std::int32_t> work = std::vector<std::int32_t>(kColumns * kLaneMultiple);
  std::vector<std::int32_t> winners = std::vector<std::int32_t>(kColumns);
  std::vector<float> disparity_px = std::vector<float>(kColumns);
  std::vector<float> cells = random_cells();
  std::vector<float> best = std::vector<float>(kColumns);
  std::vector<float> confidence = std::vector<float>(kColumns);

  static constexpr int kPixels = 512;

  template <typename Pixel>
  static std::vector<Pixel> random_pixels() {
    std::mt19937 random(1);
    std::vector<Pixel> pixels(kPixels);
    for (Pixel& pixel : pixels) {
      pixel = static_cast<Pixel>(random() % 256);
    }
    return pixels;
  }

  /// In (0, 1]: energies or probabilities.
  static std::vector<float> random_cells() {
    std::mt19937 random(2);
    std::vector<float> cells(kColumns * kLanes);
    for (float& cell : cells) {
      cell = static_cast<float>(random() % 65536 + 1) / 65536.0F;
    }
    return cells;
  }

  void interleave() {
    interleave_rows(entering.data(), leaving.data(), kIndexBits / 2, kInputColumns,
                    reference_pairs.data());
    interleave_rows(leaving.data(), entering.data(), kIndexBits / 2, kInputColumns + kLanes,
                    partner_pairs.data());
  }
  void column_ssd_8_bit() {
    column_ssd_row(ColumnSsdPairs{reference_pairs.data(), partner_pairs.data() + kInputColumns, -1,
                                  kInputColumns, kLanes},
                   column_sums.data(), column_sums.data());
  }
  void column_ssd_float() {
    column_ssd_row(ColumnSsdFloat{entering_float.data(), leaving_float.data(),
                                  leaving_float.data() + kInputColumns,
                                  entering_float.data() + kInputColumns, -1, kInputColumns, kLanes},
                   column_sums.data(), column_sums.data());
  }
  /// Sums, and the least of each column, with or without storing the sums.
  void sum_rows(bool minima, bool store) {
    RowSum row;
    row.input = column_sums.data();
    row.input_end = kInputColumns;
    row.output_begin = kRadius;
    row.output_end = kRadius + kColumns;
    row.radius = kRadius;
    row.lanes = kLanes;
    row.number_lanes = true;
    row.output = store ? sums.data() : nullptr;
    if (minima) {
      row.minima = least.data();
      row.minima_work = work.data();
      row.candidates = kLanes;
    }
    row_sum(row);
  }
  [[nodiscard]] WinnerRow winner_row(int index_bits, int first_column) const {
    WinnerRow row;
    row.cells = sums.data();
    row.geometry = {1000, 0, kLanes, -1};
    row.first_column = first_column;
    row.columns = kColumns;
    row.window_radius = kRadius;
    row.index_bits = index_bits;
    return row;
  }
  void select(int index_bits) { select_winners_row(winner_row(index_bits, 0), winners.data()); }
  void locate() { locate_minima_row(sums.data(), least.data(), kLanes, kColumns, winners.data()); }
  [[nodiscard]] CellRow cell_row(int first_column, bool probabilities) const {
    return {cells.data(), {1000, 0, kLanes, -1}, first_column, kColumns, 0, probabilities};
  }
  void select_cells(int first_column, bool probabilities, bool margin) {
    select_cell_winners_row(cell_row(first_column, probabilities),
                            {winners.data(), best.data(), margin ? confidence.data() : nullptr});
  }
  void entropy() { cell_entropy_row(cell_row(500, false), best.data(), 9.0F, confidence.data()); }
  void parabola_cells(bool probabilities) {
    parabola_disparity_row(cell_row(500, probabilities), winners.data(), disparity_px.data());
  }
  void mean_energies() { mean_energy_row(winner_row(kIndexBits, 500), {9, 0.5, 3}, cells.data()); }
  void parabola() {
    parabola_disparity_row(winner_row(kIndexBits, 500), winners.data(), disparity_px.data());
  }
};

using Kernel = std::function<void(Rows&)>;

void run(benchmark::State& state, long long target, const Kernel& kernel) {
  force_target(target);
  Rows rows;
  rows.interleave();
  rows.column_ssd_8_bit();
  rows.sum_rows(true, true);
  rows.select(kIndexBits);
  for (auto _ : state) {
    kernel(rows);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * kColumns * kLanes);
  force_target(0);
}

void register_all() {
  const std::vector<std::pair<std::string, Kernel>> kernels = {
      {"interleave_rows", [](Rows& rows) { rows.interleave(); }},
      {"column_ssd_row/8-bit", [](Rows& rows) { rows.column_ssd_8_bit(); }},
      {"column_ssd_row/float", [](Rows& rows) { rows.column_ssd_float(); }},
      {"row_sum/sums", [](Rows& rows) { rows.sum_rows(false, true); }},
      {"row_sum/minima", [](Rows& rows) { rows.sum_rows(true, false); }},
      {"row_sum/both", [](Rows& rows) { rows.sum_rows(true, true); }},
      {"locate_minima_row", [](Rows& rows) { rows.locate(); }},
      {"select_winners_row/indexed, border", [](Rows& rows) { rows.select(kIndexBits); }},
      {"select_winners_row/plain, border", [](Rows& rows) { rows.select(0); }},
      {"parabola_disparity_row/sums", [](Rows& rows) { rows.parabola(); }},
      {"parabola_disparity_row/energies", [](Rows& rows) { rows.parabola_cells(false); }},
      {"parabola_disparity_row/probabilities", [](Rows& rows) { rows.parabola_cells(true); }},
      {"select_cell_winners_row/energies",
       [](Rows& rows) { rows.select_cells(500, false, false); }},
      {"select_cell_winners_row/probabilities",
       [](Rows& rows) { rows.select_cells(500, true, false); }},
      {"select_cell_winners_row/energies, border",
       [](Rows& rows) { rows.select_cells(0, false, false); }},
      {"select_cell_winners_row/margin", [](Rows& rows) { rows.select_cells(500, false, true); }},
      {"cell_entropy_row", [](Rows& rows) { rows.entropy(); }},
      {"mean_energy_row", [](Rows& rows) { rows.mean_energies(); }},
  };
  const long long targets = available_targets();
  for (int bit = 0; bit < 63; ++bit) {
    const long long target = 1LL << bit;
    if ((targets & target) == 0) {
      continue;
    }
    for (const auto& [name, kernel] : kernels) {
      benchmark::RegisterBenchmark(
          (name + "/" + std::string(target_name(target))).c_str(),
          [target, kernel = kernel](benchmark::State& state) { run(state, target, kernel); });
    }
  }
}

}  // namespace
}  // namespace vantage::kernels

int main(int argc, char** argv) {
  vantage::kernels::register_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 2;
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
