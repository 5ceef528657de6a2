#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "kernels/candidates.h"
#include "kernels/cells/fixed_energy.h"
#include "kernels/star_row.h"

namespace vantage::kernels {

// Bayesian diffusion (6.32)–(6.37) with the maximum term of the prior's sum (6.35) instead of the
// sum, in energies E = −ln p above their column's minimum. Products become sums and maxima become
// minima; no powers or logarithms remain. All results are integers and identical on every
// instruction set.

/// The prior along a column: ES(i) = min(E(i), E(i ± k) + rises[k − 1], ceiling), the support of a
/// neighbour for disparity i. The ceiling, ln((1 − εP)/εP), is the contamination, which is the same
/// for all offsets.
struct EnergyPrior {
  const FixedEnergy* rises = nullptr;  ///< k²/2σP² for k = 1 … radius, each below the ceiling
  int radius = 0;
  FixedEnergy ceiling = 0;
};

/// Weights of each column's neighbours, including the factor μ (7.3). Weights of neutral columns
/// are arbitrary.
struct EnergyStarWeights {
  const FixedWeight* beside = nullptr;  ///< [x], x in [0, columns]: between columns x − 1 and x
  const FixedWeight* above = nullptr;   ///< [x], x in [0, columns): for the column above x
  const FixedWeight* below = nullptr;   ///< [x]: for the column below x

  [[nodiscard]] bool are_given() const { return beside != nullptr; }
};

/// One row of an iteration: E = E0 + μ · ES + Σ weight · ES over the neighbours. Cells are ES, 0 in
/// neutral columns; `star.source` holds E0. The sum over a star without its source must stay below
/// kMaxEnergy minus the ceiling.
struct MaxProductRow {
  CellStarRow<FixedEnergy> star;
  EnergyPrior prior;
  FixedWeight mu = 0x4000;
  EnergyStarWeights weights = {};  ///< absent: all neighbours have weight μ
  /// true: the output is ES, the input of the next iteration; false: E above its column's minimum.
  bool smooths = true;
  FixedEnergy* output = nullptr;  ///< must not overlap the input
  /// Cells between columns of star.source and of the output; ≥ star.lanes, multiples of
  /// kLaneMultiple.
  std::ptrdiff_t source_pitch = 0;
  std::ptrdiff_t output_pitch = 0;
  /// Ends of the runs of lanes with consecutive candidates; the prior does not cross from one run
  /// to the next. Multiples of kLaneMultiple, ascending, the last one star.lanes; empty: all lanes
  /// are one run.
  std::span<const int> segment_ends;
  /// For a two-dimensional search: rises are those of an offset's squared length. segment_ends must
  /// then be empty.
  CandidatePlane plane = {};
  /// max_product_work_cells() cells, 64-byte aligned; contents may be arbitrary.
  FixedEnergy* work = nullptr;
};

/// Columns whose energies are in work memory at a time: some are summed while others are smoothed.
inline int max_product_work_columns(int lanes) {
  constexpr int kMaxCells = 2048;
  return std::clamp(kMaxCells / lanes, 1, 16);
}

/// Number of unreachable cells (kMaxEnergy) that smoothing needs on each side of a run of
/// candidates.
inline int max_product_work_margin(int prior_radius) {
  return (prior_radius + kLaneMultiple - 1) / kLaneMultiple * kLaneMultiple;
}

/// `segments`: number of MaxProductRow::segment_ends. `plane`: for a two-dimensional search.
inline int max_product_work_cells(int lanes, int prior_radius, int segments = 1,
                                  const CandidatePlane& plane = {}) {
  return max_product_work_columns(lanes) *
             (lanes + (segments + 1) * max_product_work_margin(prior_radius)) +
         (plane.is_given() ? plane.work_cells(max_product_work_margin(prior_radius)) : 0);
}

/// Before the first iteration: E = E0. Reads only star.source, columns and lanes.
void max_product_start_row(const MaxProductRow& row);
void max_product_row(const MaxProductRow& row);

}  // namespace vantage::kernels
