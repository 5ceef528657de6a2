#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "kernels/candidates.h"
#include "kernels/cells/fixed_energy.h"
#include "kernels/star_row.h"

namespace vantage::kernels {

// Bayesian diffusion (6.32)–(6.37) with the largest term of the prior's sum (6.35) in place of the
// sum, in energies E = −ln p above the least of their column: products become sums, the largest the
// least, and neither powers nor logarithms are left. All results are whole numbers and identical on
// every instruction set.

/// The prior: what a neighbour that has the disparity i + k says of disparity i,
/// ES(i) = min(E(i), E(i ± k) + rises[k − 1], ceiling). The ceiling, ln((1 − εP)/εP), stands for
/// the contamination, which all offsets share.
struct EnergyPrior {
  const FixedEnergy* rises = nullptr;  ///< k²/2σP² for k = 1 … radius, each below the ceiling
  int radius = 0;
  FixedEnergy ceiling = 0;
};

/// How much the neighbours of each column count, μ included (7.3). Weights of neighbours that are
/// neutral columns are any.
struct EnergyStarWeights {
  const FixedWeight* beside = nullptr;  ///< [x], x in [0, columns]: of columns x − 1 and x
  const FixedWeight* above = nullptr;   ///< [x], x in [0, columns): of the column above x
  const FixedWeight* below = nullptr;   ///< [x]: of the column below x

  [[nodiscard]] bool are_given() const { return beside != nullptr; }
};

/// One row of an iteration: E = E0 + μ · ES + Σ weight · ES over the neighbours. Cells are ES, 0 in
/// neutral columns; `star.source` holds E0. Sums over a star without its source stay below
/// kMostEnergy less the ceiling.
struct MaxProductRow {
  CellStarRow<FixedEnergy> star;
  EnergyPrior prior;
  FixedWeight mu = 0x4000;
  EnergyStarWeights weights = {};  ///< not given: all neighbours count μ
  /// Whether the output is ES, which the next iteration looks at; else it is E itself above the
  /// least of its column.
  bool smooths = true;
  FixedEnergy* output = nullptr;  ///< not an input
  /// Cells from column to column of star.source and of the output, ≥ star.lanes, multiples of
  /// kLaneMultiple.
  std::ptrdiff_t source_pitch = 0;
  std::ptrdiff_t output_pitch = 0;
  /// Where runs of lanes end whose candidates follow each other: the prior does not reach from one
  /// to the next. Multiples of kLaneMultiple, ascending, the last one star.lanes; empty: all lanes
  /// are one run.
  std::span<const int> segment_ends;
  /// Where candidates are displacements in two dimensions: rises are those of the squared length of
  /// an offset. segment_ends is empty then.
  CandidatePlane plane = {};
  /// max_product_work_cells() cells, 64-byte aligned; any contents.
  FixedEnergy* work = nullptr;
};

/// Columns whose energies are in work memory at a time: while some are summed up, others are
/// smoothed.
inline int max_product_work_columns(int lanes) {
  constexpr int kMostCells = 2048;
  return std::clamp(kMostCells / lanes, 1, 16);
}

/// Cells beyond reach that smoothing needs on either side of a run of candidates.
inline int max_product_work_margin(int prior_radius) {
  return (prior_radius + kLaneMultiple - 1) / kLaneMultiple * kLaneMultiple;
}

/// `segments`: of lanes, see MaxProductRow::segment_ends. `plane`: of a search in two dimensions.
inline int max_product_work_cells(int lanes, int prior_radius, int segments = 1,
                                  const CandidatePlane& plane = {}) {
  return max_product_work_columns(lanes) *
             (lanes + (segments + 1) * max_product_work_margin(prior_radius)) +
         (plane.is_given() ? plane.work_cells(max_product_work_margin(prior_radius)) : 0);
}

/// Before the first iteration: E = E0. Only star.source, columns and lanes are looked at.
void max_product_start_row(const MaxProductRow& row);
void max_product_row(const MaxProductRow& row);

/// The same, plainly.
void max_product_start_row_ref(const MaxProductRow& row);
void max_product_row_ref(const MaxProductRow& row);

}  // namespace vantage::kernels
