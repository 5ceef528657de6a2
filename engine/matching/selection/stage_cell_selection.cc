#include "engine/matching/selection/stage_cell_selection.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/column_work.h"
#include "engine/error.h"
#include "kernels/parabola/parabola.h"

namespace vantage {
namespace {

using scheduler::Extent;
using scheduler::Range;

class CellSelectionStage final : public scheduler::RowStage {
 public:
  CellSelectionStage(const kernels::CandidateGeometry& geometry,
                     const CellSelectionSettings& settings, const MapOutputs& outputs)
      : RowStage({geometry.width, outputs.disparity_px.height()}),
        geometry_(geometry),
        settings_(settings),
        outputs_(outputs) {
    const bool of_probabilities = settings.confidence == ConfidenceMeasure::kProbability;
    if (!outputs.confidence.empty() && of_probabilities != settings.cells_are_probabilities) {
      throw Error(of_probabilities
                      ? "confidence is a probability, expected a measure of energies: evidence, "
                        "margin or entropy"
                      : "confidence is a measure of energies, expected that of probabilities");
    }
  }

  [[nodiscard]] std::string_view name() const override { return "cell selection"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return 0; }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    const bool has_confidence = !outputs_.confidence.empty();
    const bool margin = has_confidence && settings_.confidence == ConfidenceMeasure::kMargin;
    kernels::KernelWork work = kernels::cell_winner_work(true, margin) +
                               (settings_.subpixel == Subpixel::kParabola
                                    ? kernels::parabola_work(settings_.cells_are_probabilities)
                                    : kernels::kIntegerDisparityWork);
    if (has_confidence && settings_.confidence == ConfidenceMeasure::kEntropy) {
      work = work + kernels::kCellEntropyWork;
    }
    return vantage::column_work(work, geometry_.count);
  }

  void make_row(const scheduler::RowTask& task) const override {
    const std::ptrdiff_t lanes = geometry_.lanes();
    const auto* cells = task.input.row<float>(task.y);
    kernels::CellRow row;
    row.geometry = geometry_;
    row.probabilities = settings_.cells_are_probabilities;
    for (int x = task.columns.begin; x < task.columns.end; x += kBlockColumns) {
      row.cells = cells + (x - task.input.columns().begin) * lanes;
      row.first_column = x;
      row.columns = std::min(kBlockColumns, task.columns.end - x);
      select_block(row, task.y);
    }
  }

 private:
  /// Columns per block: few enough to stay in the level-1 cache until they are read again.
  static constexpr int kBlockColumns = 32;

  void select_block(const kernels::CellRow& row, int y) const {
    std::array<std::int32_t, kBlockColumns> winners;
    std::array<float, kBlockColumns> best;
    const auto part = [&](const ImageView<float>& view) {
      return view.empty() ? nullptr : view.row(y) + row.first_column;
    };
    float* disparity_px = part(outputs_.disparity_px);
    float* confidence = part(outputs_.confidence);
    select_cells(settings_, row, winners.data(), best.data(), confidence);
    if (settings_.subpixel == Subpixel::kParabola) {
      kernels::parabola_disparity_row(row, winners.data(), disparity_px);
    } else {
      kernels::integer_disparity_row(row, winners.data(), disparity_px);
    }
  }

  kernels::CandidateGeometry geometry_;
  CellSelectionSettings settings_;
  MapOutputs outputs_;
};

}  // namespace

void select_cells(const CellSelectionSettings& settings, const kernels::CellRow& row,
                  std::int32_t* winners, float* best, float* confidence) {
  const bool is_margin = settings.confidence == ConfidenceMeasure::kMargin;
  kernels::select_cell_winners_row(row, {winners, best, is_margin ? confidence : nullptr});
  if (confidence == nullptr) {
    return;
  }
  switch (settings.confidence) {
    case ConfidenceMeasure::kEvidence:
      std::transform(best, best + row.columns, confidence, [](float energy) { return -energy; });
      break;
    case ConfidenceMeasure::kEntropy:
      kernels::cell_entropy_row(row, best, settings.entropy_scale, confidence);
      break;
    case ConfidenceMeasure::kProbability:
      std::copy_n(best, row.columns, confidence);
      break;
    case ConfidenceMeasure::kMargin:
      break;
  }
}

std::unique_ptr<scheduler::RowStage> make_cell_selection_stage(
    const kernels::CandidateGeometry& geometry, const CellSelectionSettings& settings,
    const MapOutputs& outputs) {
  return std::make_unique<CellSelectionStage>(geometry, settings, outputs);
}

}  // namespace vantage
