#pragma once

#include <array>
#include <cstddef>

#include "engine/matching/levels/candidate_blocks.h"
#include "engine/matching/parameters/method_parameters.h"
#include "engine/matching/selection/stage_cell_selection.h"
#include "kernels/candidates.h"
#include "kernels/cells/fixed_energy.h"
#include "kernels/kernel_work.h"
#include "scheduler/range.h"

namespace vantage {

/// Winners of a few columns of fixed-point energies, and their confidence. Thread rule: all
/// functions are const.
class EnergySelector {
 public:
  using FixedEnergy = kernels::FixedEnergy;
  static constexpr int kMaxColumns = CandidateBlocks::kMaxRunColumns;

  /// Energies of at most kMaxColumns columns, relative to the minimum of each.
  struct Columns {
    const FixedEnergy* cells = nullptr;
    std::ptrdiff_t pitch = 0;  ///< cells between columns
    int first = 0;             ///< column of the image
    int count = 0;
    BlockList blocks = {};  ///< whose lanes the cells occupy; empty: all candidates
  };
  struct Selected {
    std::array<float, kMaxColumns> disparity_px = {};
    std::array<FixedEnergy, kMaxColumns> min = {};
    std::array<float, kMaxColumns> probability = {};  ///< if the outputs need it
  };

  EnergySelector(Subpixel subpixel, float steps_per_nat, const MapOutputs& outputs)
      : is_refined_(subpixel == Subpixel::kParabola),
        steps_per_nat_(steps_per_nat),
        outputs_(outputs) {}

  /// Per candidate.
  [[nodiscard]] kernels::KernelWork work() const;
  /// `geometry`: says which candidates of a column have partners.
  void select(const kernels::CandidateGeometry& geometry, const Columns& columns,
              Selected& selected) const;
  /// Stores columns [x, x + count) of row y.
  void write(const Selected& selected, int x, int y, int count) const;

 private:
  [[nodiscard]] bool wants_probability() const { return !outputs_.confidence.empty(); }
  void select_segment(const kernels::CandidateGeometry& geometry, const Columns& columns,
                      scheduler::Range lanes, int first_candidate, Selected& selected) const;

  bool is_refined_;
  float steps_per_nat_;
  MapOutputs outputs_;
};

}  // namespace vantage
