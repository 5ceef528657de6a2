#include "engine/matching/selection/stage_window_selection.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "engine/column_work.h"
#include "engine/error.h"
#include "kernels/cell_winner/cell_winner.h"
#include "kernels/mean_energy/mean_energy.h"
#include "kernels/parabola/parabola.h"
#include "kernels/row_sum/row_sum.h"
#include "kernels/winner/winner.h"

namespace vantage {
namespace {

using scheduler::Extent;
using scheduler::Range;

class WindowSelectionStage final : public scheduler::RowStage {
 public:
  WindowSelectionStage(const kernels::CandidateGeometry& geometry,
                       const WindowSelectionSettings& settings, const MapOutputs& outputs)
      : RowStage({geometry.width, outputs.disparity_px.height()}),
        geometry_(geometry),
        settings_(settings),
        lanes_(static_cast<std::size_t>(geometry.lanes())),
        outputs_(outputs) {
    if (wants_confidence() && settings.confidence == ConfidenceMeasure::kProbability) {
      throw Error(
          "confidence is a probability, expected a measure of energies: evidence, margin "
          "or entropy");
    }
  }

  [[nodiscard]] std::string_view name() const override { return "window selection"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return 0; }
  [[nodiscard]] Range input_columns(Range columns, Extent input) const override {
    return columns.widened(settings_.radius, input.all_columns());
  }
  /// For one block of columns: sums, lane-by-lane minima, minima and winners; the running window
  /// sums from block to block; the mean energies of a block if all are needed; and what the writer
  /// of a volume needs.
  [[nodiscard]] std::size_t state_bytes(Range /*columns*/, Extent /*input*/) const override {
    return sizeof(std::int32_t) * (kBlockColumns * (lanes_ + kernels::kLaneMultiple + 2) + lanes_) +
           (needs_all_energies() ? sizeof(float) * kBlockColumns * lanes_ : 0) +
           (settings_.volume != nullptr ? sizeof(float) * settings_.volume->work_floats() : 0);
  }
  /// For rows and columns with complete windows.
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    const bool indexed = settings_.index_bits > 0;
    kernels::KernelWork work =
        kernels::row_sum_work(keeps_sums()) +
        (has_parabola() ? kernels::parabola_work(false) : kernels::kIntegerDisparityWork);
    if (!indexed) {
      work = work + kernels::kLocateMinimaWork;
    }
    if (wants_energies()) {
      work = work + kernels::kWinnerEnergyWork;
    }
    if (needs_all_energies()) {
      work = work + kernels::kMeanEnergyWork;
    }
    if (compares_energies()) {
      work = work + (settings_.confidence == ConfidenceMeasure::kMargin
                         ? kernels::cell_winner_work(false, true)
                         : kernels::kCellEntropyWork);
    }
    return vantage::column_work(work, geometry_.count);
  }

  void make_row(const scheduler::RowTask& task) const override {
    const bool whole_windows = settings_.border == Border::kValid;
    if (whole_windows &&
        (task.y < settings_.radius || task.y >= extent().rows - settings_.radius)) {
      for (const auto& map : {outputs_.disparity_px, outputs_.confidence}) {
        if (!map.empty()) {
          std::fill_n(map.row(task.y) + task.columns.begin, task.columns.size(),
                      std::numeric_limits<float>::quiet_NaN());
        }
      }
      if (settings_.volume != nullptr) {
        settings_.volume->write_nothing(task.columns.begin, task.y, task.columns.size(),
                                        reinterpret_cast<float*>(task.state));
      }
      return;
    }
    kernels::WinnerRow row;
    row.geometry = geometry_;
    row.first_column = task.columns.begin;
    row.columns = task.columns.size();
    row.window_radius = settings_.radius;
    row.index_bits = settings_.index_bits;
    row.whole_windows_only = whole_windows;
    const kernels::CandidateRange plain = row.plain_columns();
    select(task, row, {task.columns.begin, plain.begin}, false);
    select(task, row, {plain.begin, plain.end}, true);
    select(task, row, {plain.end, task.columns.end}, false);
  }

 private:
  /// Columns whose sums are stored at a time: few enough for the level-1 cache along with the input
  /// row.
  static constexpr int kBlockColumns = 32;

  [[nodiscard]] bool has_parabola() const { return settings_.subpixel == Subpixel::kParabola; }
  [[nodiscard]] bool wants_confidence() const { return !outputs_.confidence.empty(); }
  [[nodiscard]] bool wants_energies() const {
    return wants_confidence() || settings_.volume != nullptr;
  }
  /// Whether columns with complete windows need more of their sums than the minimum.
  [[nodiscard]] bool keeps_sums() const {
    return settings_.index_bits == 0 || has_parabola() || wants_energies();
  }
  [[nodiscard]] bool needs_all_energies() const {
    return compares_energies() || settings_.volume != nullptr;
  }
  /// Whether the confidence needs the energies of all candidates.
  [[nodiscard]] bool compares_energies() const {
    return wants_confidence() && settings_.confidence != ConfidenceMeasure::kEvidence;
  }

  /// Selects `columns` of the row, either all plain (every candidate has its complete window) or
  /// none.
  void select(const scheduler::RowTask& task, const kernels::WinnerRow& row, Range columns,
              bool plain) const {
    for (int x = columns.begin; x < columns.end; x += kBlockColumns) {
      select_block(task, row, {x, std::min(x + kBlockColumns, columns.end)}, plain);
    }
  }

  void select_block(const scheduler::RowTask& task, kernels::WinnerRow row, Range columns,
                    bool plain) const {
    const bool indexed = settings_.index_bits > 0;
    auto* cells = reinterpret_cast<std::int32_t*>(task.state);
    std::int32_t* work = cells + kBlockColumns * lanes_;
    std::int32_t* minima = work + kBlockColumns * kernels::kLaneMultiple;
    std::int32_t* winners = minima + kBlockColumns;

    kernels::RowSum sum;
    sum.input = task.input.row<std::int32_t>(task.y);
    sum.input_begin = task.input.columns().begin;
    sum.input_end = task.input.columns().end;
    sum.output_begin = columns.begin;
    sum.output_end = columns.end;
    sum.radius = settings_.radius;
    sum.lanes = geometry_.lanes();
    sum.number_lanes = indexed;
    sum.window_sums = winners + kBlockColumns;
    sum.continues = columns.begin > task.columns.begin;
    sum.output = plain && !keeps_sums() ? nullptr : cells;
    if (plain) {
      sum.minima = minima;
      sum.minima_work = work;
      sum.candidates = geometry_.count;
    }
    kernels::row_sum(sum);

    row.cells = cells;
    row.first_column = columns.begin;
    row.columns = columns.size();
    if (!plain) {
      kernels::select_winners_row(row, winners);
    } else if (indexed) {
      const std::int32_t index_mask = (1 << settings_.index_bits) - 1;
      for (int j = 0; j < columns.size(); ++j) {
        winners[j] = minima[j] & index_mask;
      }
    } else {
      kernels::locate_minima_row(cells, minima, geometry_.lanes(), columns.size(), winners);
    }
    float* disparity_px = outputs_.disparity_px.row(task.y) + columns.begin;
    if (has_parabola()) {
      kernels::parabola_disparity_row(row, winners, disparity_px);
    } else {
      kernels::integer_disparity_row(row, winners, disparity_px);
    }
    if (wants_energies()) {
      write_energies(row, task.y, winners,
                     reinterpret_cast<float*>(winners + kBlockColumns + lanes_));
    }
  }

  /// Confidence and volume of a block, through `mean_energies` where those of all
  /// candidates are needed.
  void write_energies(const kernels::WinnerRow& row, int y, const std::int32_t* winners,
                      float* mean_energies) const {
    const Range window_rows = Range{y, y + 1}.widened(settings_.radius, extent().all_rows());
    const kernels::EnergyUnit unit{window_rows.size(), settings_.energy_scale,
                                   settings_.energy_offset};
    std::array<float, kBlockColumns> best;
    kernels::winner_energy_row(row, unit, winners, best.data());
    if (needs_all_energies()) {
      kernels::mean_energy_row(row, unit, mean_energies);
    }
    if (settings_.volume != nullptr) {
      settings_.volume->write_values({.cells = mean_energies,
                                      .pitch = static_cast<std::ptrdiff_t>(lanes_),
                                      .x = row.first_column,
                                      .y = y,
                                      .count = row.columns},
                                     mean_energies + kBlockColumns * lanes_);
    }
    if (!wants_confidence()) {
      return;
    }
    float* confidence = outputs_.confidence.row(y) + row.first_column;
    if (!compares_energies()) {
      std::transform(best.begin(), best.begin() + row.columns, confidence,
                     [](float energy) { return -energy; });
      return;
    }
    kernels::CellRow cells;
    cells.cells = mean_energies;
    cells.geometry = geometry_;
    cells.first_column = row.first_column;
    cells.columns = row.columns;
    cells.margin = row.whole_windows_only ? settings_.radius : 0;
    if (settings_.confidence == ConfidenceMeasure::kMargin) {
      kernels::select_cell_winners_row(cells, {nullptr, nullptr, confidence});
    } else {
      kernels::cell_entropy_row(cells, best.data(), static_cast<float>(settings_.entropy_scale),
                                confidence);
    }
  }

  kernels::CandidateGeometry geometry_;
  WindowSelectionSettings settings_;
  std::size_t lanes_;
  MapOutputs outputs_;
};

}  // namespace

std::unique_ptr<scheduler::RowStage> make_window_selection_stage(
    const kernels::CandidateGeometry& geometry, const WindowSelectionSettings& settings,
    const MapOutputs& outputs) {
  return std::make_unique<WindowSelectionStage>(geometry, settings, outputs);
}

}  // namespace vantage
