#include "engine/matching/selection/symmetric_energies.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "engine/column_work.h"

namespace vantage {
namespace {

using kernels::StepEnergy;
using scheduler::Extent;
using scheduler::Range;

class SymmetricStoreStage final : public scheduler::RowStage {
 public:
  SymmetricStoreStage(std::unique_ptr<RowEnergies> energies, const EnergySteps& steps,
                      LevelVolume& volume)
      : RowStage(volume.extent()), energies_(std::move(energies)), steps_(steps), volume_(volume) {}

  [[nodiscard]] std::string_view name() const override { return "store energies"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return 0; }
  [[nodiscard]] bool needs_whole_rows() const override { return true; }
  [[nodiscard]] Range input_columns(Range /*columns*/, Extent input) const override {
    return input.all_columns();
  }
  [[nodiscard]] std::size_t state_bytes(Range /*columns*/, Extent /*input*/) const override {
    return energies_->work_bytes();
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(energies_->work() + kernels::kStepEnergiesWork,
                                energies_->geometry().count);
  }
  /// `columns` are all: a part would make the whole row as well.
  void make_row(const scheduler::RowTask& task) const override {
    if (task.columns.begin == 0) {
      steps_.convert(energies_->energies(task.input, task.y, task.state),
                     volume_.column<StepEnergy>(0, task.y));
    }
  }

 private:
  std::unique_ptr<RowEnergies> energies_;
  EnergySteps steps_;
  LevelVolume& volume_;
};

}  // namespace

EnergySteps EnergySteps::of(double min, double penalty, int width) {
  // Pairs that cost more than two unmatched pixels are never matched, but sub-pixel positions and
  // confidences look at them, too.
  constexpr double kPenalties = 16;
  constexpr double kMaxSum = 1 << 29;
  const double range = kPenalties * penalty - std::min(min, 0.0);
  const double steps = std::min((kernels::kNeverMatched - 1) / range, kMaxSum / (width * range));
  EnergySteps result;
  result.min = static_cast<float>(min);
  result.steps_per_unit = static_cast<float>(steps);
  result.match_offset = static_cast<std::int32_t>(std::lround(2 * min * steps));
  result.unmatched = std::max(1, static_cast<std::int32_t>(std::lround(2 * penalty * steps)));
  return result;
}

void EnergySteps::convert(const kernels::CellRow& row, StepEnergy* steps) const {
  constexpr float kMax = kernels::kNeverMatched - 1;
  const int lanes = row.geometry.lanes();
  const float* cells = row.cells;
  for (int j = 0; j < row.columns; ++j, cells += lanes, steps += lanes) {
    const kernels::CandidateRange candidates = row.candidates(row.first_column + j);
    std::fill_n(steps, lanes, kernels::kNeverMatched);
    for (int i = candidates.begin; i < candidates.end; ++i) {
      const float value = std::clamp((cells[i] - min) * steps_per_unit + 0.5F, 0.0F, kMax);
      steps[i] = static_cast<StepEnergy>(static_cast<std::int32_t>(value));
    }
  }
}

std::size_t symmetric_energy_bytes(const MethodParameters& parameters, Extent extent,
                                   int candidates) {
  const int lanes = kernels::CandidateGeometry{.count = candidates}.lanes();
  return parameters.selection == Selection::kSymmetric
             ? sizeof(StepEnergy) * static_cast<std::size_t>(extent.columns) *
                   static_cast<std::size_t>(extent.rows) * static_cast<std::size_t>(lanes)
             : 0;
}

std::unique_ptr<scheduler::RowStage> make_symmetric_store_stage(
    std::unique_ptr<RowEnergies> energies, const EnergySteps& steps, LevelVolume& volume) {
  return std::make_unique<SymmetricStoreStage>(std::move(energies), steps, volume);
}

}  // namespace vantage
