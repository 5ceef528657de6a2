#include "engine/matching/stage_window_selection.h"

#include <algorithm>
#include <cstdint>
#include <limits>

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
                       const WindowSelectionSettings& settings, ImageView<float> disparity_px)
      : RowStage({geometry.width, disparity_px.height()}),
        geometry_(geometry),
        settings_(settings),
        lanes_(static_cast<std::size_t>(geometry.lanes())),
        disparity_px_(disparity_px) {}

  [[nodiscard]] std::string_view name() const override { return "window selection"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return 0; }
  [[nodiscard]] Range input_columns(Range columns, Extent input) const override {
    return columns.widened(settings_.radius, input.all_columns());
  }
  /// Of one block of columns: sums, lane-by-lane minima, minima and winners; and the window's sums
  /// from block to block.
  [[nodiscard]] std::size_t state_bytes(Range /*columns*/, Extent /*input*/) const override {
    return sizeof(std::int32_t) * (kBlockColumns * (lanes_ + kernels::kLaneMultiple + 2) + lanes_);
  }

  void make_row(const scheduler::RowTask& task) const override {
    float* disparity_px = disparity_px_.row(task.y) + task.columns.begin;
    const bool whole_windows = settings_.border == Border::kValid;
    if (whole_windows &&
        (task.y < settings_.radius || task.y >= extent().rows - settings_.radius)) {
      std::fill_n(disparity_px, task.columns.size(), std::numeric_limits<float>::quiet_NaN());
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
  /// Columns whose sums are kept at a time: few enough for the level-1 cache beside the input row.
  static constexpr int kBlockColumns = 32;

  /// Makes `columns` of the row, all of them plain (every candidate has its whole window) or none.
  void select(const scheduler::RowTask& task, const kernels::WinnerRow& row, Range columns,
              bool plain) const {
    for (int x = columns.begin; x < columns.end; x += kBlockColumns) {
      select_block(task, row, {x, std::min(x + kBlockColumns, columns.end)}, plain);
    }
  }

  void select_block(const scheduler::RowTask& task, kernels::WinnerRow row, Range columns,
                    bool plain) const {
    const bool parabola = settings_.subpixel == Subpixel::kParabola;
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
    sum.output = plain && indexed && !parabola ? nullptr : cells;
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
    float* disparity_px = disparity_px_.row(task.y) + columns.begin;
    if (parabola) {
      kernels::parabola_disparity_row(row, winners, disparity_px);
    } else {
      kernels::integer_disparity_row(row, winners, disparity_px);
    }
  }

  kernels::CandidateGeometry geometry_;
  WindowSelectionSettings settings_;
  std::size_t lanes_;
  ImageView<float> disparity_px_;
};

}  // namespace

std::unique_ptr<scheduler::RowStage> make_window_selection_stage(
    const kernels::CandidateGeometry& geometry, const WindowSelectionSettings& settings,
    ImageView<float> disparity_px) {
  return std::make_unique<WindowSelectionStage>(geometry, settings, disparity_px);
}

}  // namespace vantage
