// From cells to winners: minima, sub-pixel positions, confidence.

#include <algorithm>
#include <utility>

#include "kernels/candidates.h"
#include "kernels/cell_winner/cell_winner.h"
#include "kernels/energy_winner/energy_winner.h"
#include "kernels/mean_energy/mean_energy.h"
#include "kernels/parabola/parabola.h"
#include "kernels/winner/winner.h"
#include "perf/kernels_benchmark/kernel_benchmark.h"

namespace vantage::perf {
namespace {

constexpr int kColumns = 64;
constexpr int kLanes = 64;
constexpr double kCells = kColumns * kLanes;
constexpr std::size_t kCellCount = kColumns * kLanes;
constexpr int kIndexBits = 6;
// A column where every candidate has a partner, and one near the border.
constexpr int kInside = 500;
constexpr int kAtBorder = 0;

struct Rows {
  AlignedValues<std::int32_t> sums{kCellCount, 10000, 1 << kIndexBits};
  AlignedValues<std::int32_t> min{kColumns};
  AlignedValues<std::int32_t> winners{kColumns};
  AlignedValues<float> cells{kCellCount, 65536, 1.0F / 65536, 2};
  AlignedValues<kernels::FixedEnergy> fixed{kCellCount, 30000, 1, 3};
  AlignedValues<kernels::FixedEnergy> min_fixed{kColumns};
  AlignedValues<std::int32_t> fixed_winners{kColumns};
  AlignedValues<float> energies{kCellCount};
  AlignedValues<float> best{kColumns};
  AlignedValues<float> confidence{kColumns};
  AlignedValues<float> disparity_px{kColumns};

  Rows() {
    for (int x = 0; x < kColumns; ++x) {
      const std::int32_t* column = sums.data() + x * kLanes;
      min.data()[x] = *std::min_element(column, column + kLanes);
    }
    locate();
    select_energies(kInside);
    select_cells(kInside, false, false);
  }
  [[nodiscard]] kernels::WinnerRow winner_row(int index_bits, int first_column) {
    kernels::WinnerRow row;
    row.cells = sums.data();
    row.geometry = {1000, 0, kLanes, -1};
    row.first_column = first_column;
    row.columns = kColumns;
    row.window_radius = 4;
    row.index_bits = index_bits;
    return row;
  }
  [[nodiscard]] kernels::CellRow cell_row(int first_column, bool probabilities) {
    return {cells.data(), {1000, 0, kLanes, -1}, first_column, kColumns, 0, probabilities};
  }
  void locate() {
    kernels::locate_minima_row(sums.data(), min.data(), kLanes, kColumns, winners.data());
  }
  void select(int index_bits) {
    kernels::select_winners_row(winner_row(index_bits, kAtBorder), winners.data());
  }
  void select_cells(int first_column, bool probabilities, bool margin) {
    kernels::select_cell_winners_row(
        cell_row(first_column, probabilities),
        {winners.data(), best.data(), margin ? confidence.data() : nullptr});
  }
  [[nodiscard]] kernels::EnergyRow energy_row(int first_column) {
    return {fixed.data(), kLanes, {1000, 0, kLanes, -1}, first_column, kColumns};
  }
  void select_energies(int first_column) {
    kernels::select_energy_winners_row(energy_row(first_column), fixed_winners.data(),
                                       min_fixed.data());
  }
  void parabola_of_energies() {
    kernels::energy_disparity_row(energy_row(kInside), fixed_winners.data(), true,
                                  disparity_px.data());
  }
  void probability_of_energies() {
    kernels::energy_probability_row({fixed.data(), kLanes, kColumns, kLanes}, min_fixed.data(), 256,
                                    confidence.data());
  }
  void entropy() {
    kernels::cell_entropy_row(cell_row(kInside, false), best.data(), 9.0F, confidence.data());
  }
  void parabola_of_cells(bool probabilities) {
    kernels::parabola_disparity_row(cell_row(kInside, probabilities), winners.data(),
                                    disparity_px.data());
  }
  void parabola_of_sums() {
    kernels::parabola_disparity_row(winner_row(0, kInside), winners.data(), disparity_px.data());
  }
  void mean_energies() {
    kernels::mean_energy_row(winner_row(kIndexBits, kInside), {9, 0.5, 3}, energies.data());
  }
};

KernelBenchmark of_cells(std::string name, const kernels::KernelWork& work, void (*call)(Rows&)) {
  return on_own_data<Rows>(std::move(name), "cell", kCells, per_cell(work, kLanes), call);
}

// Fractions are compared, which the table does not count; cells are read once or twice.
constexpr kernels::KernelWork kIndexedAtBorderWork = {0, 0, 1, 0};
constexpr kernels::KernelWork kPlainAtBorderWork = {0, 0, 2, 0};

KernelBenchmark parabola(std::string name, bool of_probabilities, void (*call)(Rows&)) {
  return on_own_data<Rows>(std::move(name), "pixel", kColumns,
                           per_column(kernels::parabola_work(of_probabilities)), call);
}

KernelBenchmark parabola_of_energies() {
  KernelBenchmark kernel = on_own_data<Rows>("energy_disparity_row", "pixel", kColumns,
                                             per_column(kernels::kEnergyDisparityWork),
                                             [](Rows& d) { d.parabola_of_energies(); });
  kernel.has_vectors = false;
  return kernel;
}

}  // namespace

KernelBenchmarks selection_kernels() {
  return {
      of_cells("locate_minima_row", kernels::kLocateMinimaWork, [](Rows& d) { d.locate(); }),
      of_cells("select_winners_row/indexed, border", kIndexedAtBorderWork,
               [](Rows& d) { d.select(kIndexBits); }),
      of_cells("select_winners_row/plain, border", kPlainAtBorderWork,
               [](Rows& d) { d.select(0); }),
      of_cells("mean_energy_row", kernels::kMeanEnergyWork, [](Rows& d) { d.mean_energies(); }),
      of_cells("select_cell_winners_row/energies", kernels::cell_winner_work(true, false),
               [](Rows& d) { d.select_cells(kInside, false, false); }),
      of_cells("select_cell_winners_row/probabilities", kernels::cell_winner_work(true, false),
               [](Rows& d) { d.select_cells(kInside, true, false); }),
      of_cells("select_cell_winners_row/energies, border", kernels::cell_winner_work(true, false),
               [](Rows& d) { d.select_cells(kAtBorder, false, false); }),
      of_cells("select_cell_winners_row/margin", kernels::cell_winner_work(true, true),
               [](Rows& d) { d.select_cells(kInside, false, true); }),
      of_cells("select_energy_winners_row", kernels::energy_winner_work(),
               [](Rows& d) { d.select_energies(kInside); }),
      of_cells("select_energy_winners_row/border", kernels::energy_winner_work(),
               [](Rows& d) { d.select_energies(kAtBorder); }),
      of_cells("energy_probability_row", kernels::kEnergyProbabilityWork,
               [](Rows& d) { d.probability_of_energies(); }),
      of_cells("cell_entropy_row", kernels::kCellEntropyWork, [](Rows& d) { d.entropy(); }),
      parabola("parabola_disparity_row/sums", false, [](Rows& d) { d.parabola_of_sums(); }),
      parabola("parabola_disparity_row/energies", false,
               [](Rows& d) { d.parabola_of_cells(false); }),
      parabola("parabola_disparity_row/probabilities", true,
               [](Rows& d) { d.parabola_of_cells(true); }),
      parabola_of_energies(),
  };
}

}  // namespace vantage::perf
