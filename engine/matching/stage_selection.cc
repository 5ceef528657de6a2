#include "engine/matching/stage_selection.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "kernels/parabola/parabola.h"
#include "kernels/winner/winner.h"

namespace vantage {
namespace {

class SelectionStage final : public scheduler::RowStage {
 public:
  SelectionStage(const kernels::CandidateGeometry& geometry, const SelectionSettings& settings,
                 ImageView<float> disparity_px)
      : RowStage({geometry.width, disparity_px.height()}),
        geometry_(geometry),
        settings_(settings),
        disparity_px_(disparity_px) {}

  [[nodiscard]] std::string_view name() const override { return "selection"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return 0; }
  [[nodiscard]] std::size_t state_bytes(scheduler::Range columns,
                                        scheduler::Extent /*input*/) const override {
    return sizeof(std::int32_t) * static_cast<std::size_t>(columns.size());
  }

  void make_row(const scheduler::RowTask& task) const override {
    float* disparity_px = disparity_px_.row(task.y) + task.columns.begin;
    const bool whole_windows = settings_.border == Border::kValid;
    if (whole_windows &&
        (task.y < settings_.window_radius || task.y >= extent().rows - settings_.window_radius)) {
      std::fill_n(disparity_px, task.columns.size(), std::numeric_limits<float>::quiet_NaN());
      return;
    }
    kernels::WinnerRow row;
    row.cells = task.input.row<std::int32_t>(task.y) +
                static_cast<std::size_t>(task.columns.begin - task.input.columns().begin) *
                    static_cast<std::size_t>(geometry_.lanes());
    row.geometry = geometry_;
    row.first_column = task.columns.begin;
    row.columns = task.columns.size();
    row.window_radius = settings_.window_radius;
    row.index_bits = settings_.index_bits;
    row.whole_windows_only = whole_windows;
    auto* winners = reinterpret_cast<std::int32_t*>(task.state);
    kernels::select_winners_row(row, winners);
    if (settings_.subpixel == Subpixel::kParabola) {
      kernels::parabola_disparity_row(row, winners, disparity_px);
    } else {
      kernels::integer_disparity_row(row, winners, disparity_px);
    }
  }

 private:
  kernels::CandidateGeometry geometry_;
  SelectionSettings settings_;
  ImageView<float> disparity_px_;
};

}  // namespace

std::unique_ptr<scheduler::RowStage> make_selection_stage(
    const kernels::CandidateGeometry& geometry, const SelectionSettings& settings,
    ImageView<float> disparity_px) {
  return std::make_unique<SelectionStage>(geometry, settings, disparity_px);
}

}  // namespace vantage
