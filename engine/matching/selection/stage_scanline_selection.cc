#include "engine/matching/selection/stage_scanline_selection.h"
#include "engine/matching/selection/whole_row_stage.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "engine/column_work.h"
#include "kernels/cell_winner/cell_winner.h"
#include "kernels/parabola/parabola.h"

namespace vantage {
namespace {

using scheduler::Extent;
using scheduler::Range;

class ScanlineSelectionStage final : public WholeRowStage {
 public:
  ScanlineSelectionStage(std::unique_ptr<RowEnergies> energies, const ScanlineSettings& settings,
                         const MapOutputs& outputs)
      : WholeRowStage({energies->geometry().width, outputs.disparity_px.height()}),
        energies_(std::move(energies)),
        geometry_(energies_->geometry()),
        settings_(settings),
        outputs_(outputs) {}

  [[nodiscard]] std::string_view name() const override { return "scanline selection"; }
  [[nodiscard]] std::size_t state_bytes(Range /*columns*/, Extent /*input*/) const override {
    return place(nullptr).bytes;
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(
        energies_->work() + kernels::scanline_work(settings_.jump.passes(geometry_.count)) +
            (settings_.subpixel == Subpixel::kParabola ? kernels::parabola_work(false)
                                                       : kernels::kIntegerDisparityWork),
        geometry_.count);
  }

  void make_row(const scheduler::RowTask& task) const override {
    const Place at = place(task.state);
    const kernels::CellRow row = energies_->energies(task.input, task.y, at.energies);
    kernels::scanline_winners_row(row, settings_.jump, at.work, at.winners);
    for (int x = task.columns.begin; x < task.columns.end; x += kBlockColumns) {
      write(task, row, {x, std::min(x + kBlockColumns, task.columns.end)}, at.winners);
    }
  }

 private:
  static constexpr int kBlockColumns = 32;

  /// Parts of the state.
  struct Place {
    std::byte* energies = nullptr;
    kernels::ScanlineWork work;
    std::int32_t* winners = nullptr;
    std::size_t bytes = 0;
  };
  [[nodiscard]] Place place(std::byte* state) const {
    const auto width = static_cast<std::size_t>(geometry_.width);
    Place at;
    const auto take = [&](std::size_t bytes) {
      std::byte* const part = state == nullptr ? nullptr : state + at.bytes;
      at.bytes += cache_aligned(bytes);
      return part;
    };
    const auto floats = [&](std::size_t count) {
      return reinterpret_cast<float*>(take(sizeof(float) * count));
    };
    at.work.paths = floats(width * static_cast<std::size_t>(geometry_.lanes()));
    at.work.minima = floats(width);
    at.work.spread = floats(
        static_cast<std::size_t>(kernels::scanline_spread_floats(geometry_, settings_.jump)));
    at.winners = reinterpret_cast<std::int32_t*>(take(sizeof(std::int32_t) * width));
    at.energies = take(energies_->work_bytes());
    return at;
  }

  /// Stores `columns` of a row. `winners`: of all columns.
  void write(const scheduler::RowTask& task, kernels::CellRow row, Range columns,
             const std::int32_t* winners) const {
    row.cells += static_cast<std::ptrdiff_t>(columns.begin) * geometry_.lanes();
    row.first_column = columns.begin;
    row.columns = columns.size();
    const auto part = [&](const ImageView<float>& view) {
      return view.empty() ? nullptr : view.row(task.y) + columns.begin;
    };
    write_disparities(row, winners + columns.begin, part(outputs_.disparity_px));
    float* const confidence = part(outputs_.confidence);
    if (confidence == nullptr) {
      return;
    }
    switch (settings_.confidence) {
      case ConfidenceMeasure::kEvidence:
        write_evidence(row, winners + columns.begin, confidence);
        break;
      case ConfidenceMeasure::kMargin:
        kernels::select_cell_winners_row(row, {nullptr, nullptr, confidence});
        break;
      case ConfidenceMeasure::kEntropy: {
        std::array<float, kBlockColumns> min;
        kernels::select_cell_winners_row(row, {nullptr, min.data(), nullptr});
        kernels::cell_entropy_row(row, min.data(), settings_.entropy_scale, confidence);
        break;
      }
      case ConfidenceMeasure::kProbability:
        energies_->probabilities(task.input, task.y, columns, winners, confidence);
        break;
    }
  }

  void write_disparities(const kernels::CellRow& row, const std::int32_t* winners,
                         float* disparity_px) const {
    if (settings_.subpixel != Subpixel::kParabola) {
      kernels::integer_disparity_row(row, winners, disparity_px);
      return;
    }
    kernels::parabola_disparity_row(row, winners, disparity_px);
    // A selected candidate need not be a minimum: its parabola may point far away.
    for (int j = 0; j < row.columns; ++j) {
      const auto whole = static_cast<float>(geometry_.disparity_min + winners[j]);
      if (winners[j] != kernels::kNoWinner) {
        disparity_px[j] = std::clamp(disparity_px[j], whole - 0.5F, whole + 0.5F);
      }
    }
  }

  void write_evidence(const kernels::CellRow& row, const std::int32_t* winners,
                      float* confidence) const {
    const std::ptrdiff_t lanes = geometry_.lanes();
    for (int j = 0; j < row.columns; ++j) {
      confidence[j] = winners[j] == kernels::kNoWinner ? std::numeric_limits<float>::quiet_NaN()
                                                       : -row.cells[j * lanes + winners[j]];
    }
  }

  std::unique_ptr<RowEnergies> energies_;
  kernels::CandidateGeometry geometry_;
  ScanlineSettings settings_;
  MapOutputs outputs_;
};

}  // namespace

std::unique_ptr<scheduler::RowStage> make_scanline_selection_stage(
    std::unique_ptr<RowEnergies> energies, const ScanlineSettings& settings,
    const MapOutputs& outputs) {
  return std::make_unique<ScanlineSelectionStage>(std::move(energies), settings, outputs);
}

}  // namespace vantage
