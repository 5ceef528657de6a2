#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "engine/matching/selection/stage_window_selection.h"
#include "kernels/candidates.h"
#include "kernels/cell_winner/cell_winner.h"
#include "kernels/kernel_work.h"
#include "scheduler/range.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// `bytes` up to the next multiple of 64, for parts of a stage's state.
constexpr std::size_t cache_aligned(std::size_t bytes) {
  constexpr std::size_t kAlignment = 64;
  return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

/// Cells of any kind as a row of float energies, for selections that look at whole rows. Thread
/// rule: immutable.
class RowEnergies {
 public:
  explicit RowEnergies(const kernels::CandidateGeometry& geometry) : geometry_(geometry) {}
  RowEnergies(const RowEnergies&) = delete;
  RowEnergies& operator=(const RowEnergies&) = delete;
  virtual ~RowEnergies() = default;

  [[nodiscard]] const kernels::CandidateGeometry& geometry() const { return geometry_; }
  /// Bytes of `work` for energies().
  [[nodiscard]] virtual std::size_t work_bytes() const = 0;
  [[nodiscard]] virtual kernels::KernelWork work() const = 0;

  /// The energies of all columns of row y: geometry().lanes() floats per column, finite where a
  /// candidate counts. `work`: 64-byte aligned; the result may lie there.
  [[nodiscard]] virtual kernels::CellRow energies(const scheduler::InputRows& input, int y,
                                                  std::byte* work) const = 0;
  /// probability[x − columns.begin]: that of winners[x], NaN where there is none. Only for cells
  /// that have probabilities.
  virtual void probabilities(const scheduler::InputRows& input, int y, scheduler::Range columns,
                             const std::int32_t* winners, float* probability) const;

 protected:
  [[nodiscard]] std::size_t row_floats() const {
    return static_cast<std::size_t>(geometry_.width) * static_cast<std::size_t>(geometry_.lanes());
  }
  [[nodiscard]] kernels::CellRow row_of(const float* cells, int margin = 0) const {
    kernels::CellRow row;
    row.cells = cells;
    row.geometry = geometry_;
    row.columns = geometry_.width;
    row.margin = margin;
    return row;
  }

 private:
  kernels::CandidateGeometry geometry_;
};

/// Float cells: energies as they are, or probabilities, whose energies are −ln p, at most 87.
std::unique_ptr<RowEnergies> make_cell_energies(const kernels::CandidateGeometry& geometry,
                                                bool cells_are_probabilities);
/// Fixed-point energies (kernels::FixedEnergy), in nats.
std::unique_ptr<RowEnergies> make_fixed_energies(const kernels::CandidateGeometry& geometry,
                                                 float steps_per_nat);
/// Column sums of 32 bits: mean energies over windows, as stage_window_selection compares them.
/// Candidates count as settings.border says. `height`: rows of the image. energies() hands them to
/// settings.volume.
std::unique_ptr<RowEnergies> make_window_energies(const kernels::CandidateGeometry& geometry,
                                                  int height,
                                                  const WindowSelectionSettings& settings);

}  // namespace vantage
