#include "engine/matching/selection/stage_displacement_selection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "engine/column_work.h"
#include "engine/matching/selection/displacement_selector.h"
#include "kernels/energy_winner/energy_winner.h"
#include "kernels/mean_energy/mean_energy.h"
#include "kernels/row_sum/row_sum.h"

namespace vantage {
namespace {

using kernels::FixedEnergy;
using scheduler::Extent;
using scheduler::Range;

/// Common base: processes a few columns at a time.
class DisplacementSelectionStage : public scheduler::RowStage {
 public:
  DisplacementSelectionStage(const DisplacementGrid& grid, const CellSelectionSettings& settings,
                             int window_radius, const MapOutputs& outputs)
      : RowStage({grid.along_rows.width, grid.height}),
        grid_(grid),
        settings_(settings),
        selector_(grid, settings, window_radius),
        outputs_(outputs) {}

  [[nodiscard]] std::string_view name() const override { return "displacement selection"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return 0; }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    const bool has_confidence = !outputs_.confidence.empty();
    kernels::KernelWork work = kernels::cell_winner_work(
        true, has_confidence && settings_.confidence == ConfidenceMeasure::kMargin);
    if (settings_.subpixel == Subpixel::kParabola) {
      const kernels::KernelWork of_one = kernels::parabola_work(settings_.cells_are_probabilities);
      work = work + of_one + of_one;
    }
    if (has_confidence && settings_.confidence == ConfidenceMeasure::kEntropy) {
      work = work + kernels::kCellEntropyWork;
    }
    return vantage::column_work(work, grid_.count());
  }

  void make_row(const scheduler::RowTask& task) const override {
    for (int x = task.columns.begin; x < task.columns.end; x += kColumns) {
      make_columns(task, {x, std::min(x + kColumns, task.columns.end)});
    }
  }

 protected:
  static constexpr int kColumns = DisplacementSelector::kMaxColumns;

  [[nodiscard]] const DisplacementGrid& grid() const { return grid_; }
  [[nodiscard]] const DisplacementSelector& selector() const { return selector_; }
  [[nodiscard]] const MapOutputs& outputs() const { return outputs_; }
  [[nodiscard]] std::size_t lanes() const {
    return static_cast<std::size_t>(grid_.columns().lanes());
  }
  /// First cell of `columns`.
  template <typename Cell>
  [[nodiscard]] const Cell* cells(const scheduler::RowTask& task, Range columns) const {
    return task.input.row<Cell>(task.y) +
           static_cast<std::size_t>(columns.begin - task.input.columns().begin) * lanes();
  }
  /// At most kColumns.
  virtual void make_columns(const scheduler::RowTask& task, Range columns) const = 0;

 private:
  DisplacementGrid grid_;
  CellSelectionSettings settings_;
  DisplacementSelector selector_;
  MapOutputs outputs_;
};

class FloatDisplacementStage final : public DisplacementSelectionStage {
 public:
  FloatDisplacementStage(const DisplacementGrid& grid, const CellSelectionSettings& settings,
                         const MapOutputs& outputs)
      : DisplacementSelectionStage(grid, settings, 0, outputs) {}

  [[nodiscard]] std::size_t state_bytes(Range /*columns*/, Extent /*input*/) const override {
    return sizeof(float) * selector().work_floats();
  }

 protected:
  void make_columns(const scheduler::RowTask& task, Range columns) const override {
    selector().select({cells<float>(task, columns), task.y, columns.begin, columns.size()},
                      outputs(), reinterpret_cast<float*>(task.state));
  }
};

class EnergyDisplacementStage final : public DisplacementSelectionStage {
 public:
  EnergyDisplacementStage(const DisplacementGrid& grid, Subpixel subpixel, float steps_per_nat,
                          const MapOutputs& outputs)
      : DisplacementSelectionStage(grid, {.subpixel = subpixel}, 0, without_confidence(outputs)),
        confidence_(outputs.confidence),
        steps_per_nat_(steps_per_nat) {}

  /// Energies of some columns as floats.
  [[nodiscard]] std::size_t state_bytes(Range /*columns*/, Extent /*input*/) const override {
    return sizeof(float) * (kColumns * lanes() + selector().work_floats());
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    scheduler::ColumnWork work = DisplacementSelectionStage::column_work();
    if (!confidence_.empty()) {
      const scheduler::ColumnWork own =
          vantage::column_work(kernels::kEnergyProbabilityWork, grid().count());
      work.operations += own.operations;
      work.bytes += own.bytes;
    }
    return work;
  }

 protected:
  void make_columns(const scheduler::RowTask& task, Range columns) const override {
    const auto* const energies = cells<FixedEnergy>(task, columns);
    auto* const as_floats = reinterpret_cast<float*>(task.state);
    std::copy_n(energies, lanes() * static_cast<std::size_t>(columns.size()), as_floats);
    const DisplacementSelector::Values best =
        selector().select({as_floats, task.y, columns.begin, columns.size()}, outputs(),
                          as_floats + kColumns * lanes());
    if (confidence_.empty()) {
      return;
    }
    std::array<FixedEnergy, kColumns> min;
    std::transform(best.begin(), best.begin() + columns.size(), min.begin(), [](float energy) {
      return std::isnan(energy) ? kernels::kMaxEnergy : static_cast<FixedEnergy>(energy);
    });
    kernels::energy_probability_row({.cells = energies,
                                     .pitch = static_cast<std::ptrdiff_t>(lanes()),
                                     .columns = columns.size(),
                                     .lanes = static_cast<int>(lanes())},
                                    min.data(), steps_per_nat_,
                                    confidence_.row(task.y) + columns.begin);
  }

 private:
  /// The confidence covers all cells, including those of candidates without a partner.
  static MapOutputs without_confidence(MapOutputs outputs) {
    outputs.confidence = {};
    return outputs;
  }

  ImageView<float> confidence_;
  float steps_per_nat_;
};

CellSelectionSettings cell_settings(const WindowSelectionSettings& settings) {
  return {.subpixel = settings.subpixel,
          .confidence = settings.confidence,
          .entropy_scale = static_cast<float>(settings.entropy_scale)};
}

class WindowDisplacementStage final : public DisplacementSelectionStage {
 public:
  WindowDisplacementStage(const DisplacementGrid& grid, const WindowSelectionSettings& settings,
                          const MapOutputs& outputs)
      : DisplacementSelectionStage(grid, cell_settings(settings),
                                   settings.border == Border::kValid ? settings.radius : 0,
                                   outputs),
        settings_(settings) {}

  [[nodiscard]] Range input_columns(Range columns, Extent input) const override {
    return columns.widened(settings_.radius, input.all_columns());
  }
  /// For some columns: window sums, those of one vertical disparity and their means, all means; and
  /// the running window sums and what the writer of a volume needs.
  [[nodiscard]] std::size_t state_bytes(Range /*columns*/, Extent /*input*/) const override {
    return sizeof(float) *
           (kColumns * 2 * (lanes() + row_lanes()) + lanes() + selector().work_floats() +
            (settings_.volume != nullptr ? settings_.volume->work_floats() : 0));
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    scheduler::ColumnWork work = DisplacementSelectionStage::column_work();
    const scheduler::ColumnWork own = vantage::column_work(
        kernels::row_sum_work(true) + kernels::kMeanEnergyWork, grid().count());
    work.operations += own.operations;
    work.bytes += own.bytes;
    return work;
  }

 protected:
  void make_columns(const scheduler::RowTask& task, Range columns) const override {
    auto* const sums = reinterpret_cast<std::int32_t*>(task.state);
    std::int32_t* const row_sums = sums + kColumns * lanes();
    auto* const row_means = reinterpret_cast<float*>(row_sums + kColumns * row_lanes());
    float* const means = row_means + kColumns * row_lanes();
    float* const work = means + kColumns * lanes();
    float* const window_sums = work + selector().work_floats();
    add_up(task, columns, reinterpret_cast<std::int32_t*>(window_sums), sums);

    kernels::WinnerRow row;
    row.cells = row_sums;
    row.geometry = grid().along_rows;
    row.first_column = columns.begin;
    row.columns = columns.size();
    row.window_radius = settings_.radius;
    row.whole_windows_only = settings_.border == Border::kValid;
    const auto count = static_cast<std::size_t>(grid().along_rows.count);
    const auto each_column = [&](int candidate_row, const auto& visit) {
      for (std::size_t j = 0; j < static_cast<std::size_t>(columns.size()); ++j) {
        visit(j * lanes() + static_cast<std::size_t>(candidate_row) * count, j * row_lanes());
      }
    };
    for (int r = 0; r < grid().rows; ++r) {
      const int window_rows = rows_in_both(task.y, r);
      if (window_rows == 0) {
        continue;  // no candidates: their own row must lie in both images
      }
      each_column(r, [&](std::size_t of_all, std::size_t of_row) {
        std::copy_n(sums + of_all, count, row_sums + of_row);
      });
      kernels::mean_energy_row(row, {window_rows, settings_.energy_scale, settings_.energy_offset},
                               row_means);
      each_column(r, [&](std::size_t of_all, std::size_t of_row) {
        std::copy_n(row_means + of_row, count, means + of_all);
      });
    }
    selector().select({means, task.y, columns.begin, columns.size()}, outputs(), work);
    if (settings_.volume != nullptr) {
      settings_.volume->write_values({.cells = means,
                                      .pitch = static_cast<std::ptrdiff_t>(lanes()),
                                      .x = columns.begin,
                                      .y = task.y,
                                      .count = columns.size()},
                                     window_sums + lanes());
    }
  }

 private:
  [[nodiscard]] std::size_t row_lanes() const {
    return static_cast<std::size_t>(grid().along_rows.lanes());
  }
  /// Rows of a window that lie in both images at the vertical disparity with index `candidate_row`.
  [[nodiscard]] int rows_in_both(int y, int candidate_row) const {
    const Range window = Range{y, y + 1}.widened(settings_.radius, extent().all_rows());
    int rows = 0;
    for (int of_window = window.begin; of_window < window.end; ++of_window) {
      const int partner = grid().partner_row(of_window, candidate_row);
      rows += partner >= 0 && partner < grid().height ? 1 : 0;
    }
    return rows;
  }
  void add_up(const scheduler::RowTask& task, Range columns, std::int32_t* window_sums,
              std::int32_t* sums) const {
    kernels::RowSum sum;
    sum.input = task.input.row<std::int32_t>(task.y);
    sum.input_begin = task.input.columns().begin;
    sum.input_end = task.input.columns().end;
    sum.output_begin = columns.begin;
    sum.output_end = columns.end;
    sum.radius = settings_.radius;
    sum.lanes = static_cast<int>(lanes());
    sum.window_sums = window_sums;
    sum.continues = columns.begin > task.columns.begin;
    sum.output = sums;
    kernels::row_sum(sum);
  }

  WindowSelectionSettings settings_;
};

}  // namespace

std::unique_ptr<scheduler::RowStage> make_displacement_selection_stage(
    const DisplacementGrid& grid, const CellSelectionSettings& settings,
    const MapOutputs& outputs) {
  return std::make_unique<FloatDisplacementStage>(grid, settings, outputs);
}

std::unique_ptr<scheduler::RowStage> make_displacement_fixed_energy_selection_stage(
    const DisplacementGrid& grid, Subpixel subpixel, float steps_per_nat,
    const MapOutputs& outputs) {
  return std::make_unique<EnergyDisplacementStage>(grid, subpixel, steps_per_nat, outputs);
}

std::unique_ptr<scheduler::RowStage> make_displacement_window_selection_stage(
    const DisplacementGrid& grid, const WindowSelectionSettings& settings,
    const MapOutputs& outputs) {
  return std::make_unique<WindowDisplacementStage>(grid, settings, outputs);
}

}  // namespace vantage
