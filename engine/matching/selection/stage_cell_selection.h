#pragma once

#include <cstdint>
#include <memory>

#include "engine/image/image.h"
#include "engine/matching/parameters/method_parameters.h"
#include "kernels/candidates.h"
#include "kernels/cell_winner/cell_winner.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Confidence of a winner; larger is surer.
enum class ConfidenceMeasure {
  kEvidence,     ///< M, the evidence of the winner (5.12): −E
  kMargin,       ///< winner margin (6.13)
  kEntropy,      ///< Σ p log p ≤ 0 (6.15)
  kProbability,  ///< max p
};

/// Outputs of a selection stage: views of the size of the reference image that outlive it. NaN
/// where there is no candidate. Disparities are required; other views are empty if not requested.
struct MapOutputs {
  ImageView<float> disparity_px;
  ImageView<float> confidence = {};
  ImageView<float> disparity_y_px = {};  ///< two-dimensional search: required
};

struct CellSelectionSettings {
  /// Cells are probabilities that sum to 1 over a column's candidates and lanes; otherwise
  /// energies.
  bool cells_are_probabilities = false;
  Subpixel subpixel = Subpixel::kParabola;
  /// kProbability requires probabilities; the others require energies.
  ConfidenceMeasure confidence = ConfidenceMeasure::kMargin;
  /// Scale of kEntropy: p ∝ exp(−scale · (E − Emin)), 1/(2σM²).
  float entropy_scale = 1;
};

/// Winners of the columns of `row`, their cells and, unless `confidence` is null, how sure they
/// are.
void select_cells(const CellSelectionSettings& settings, const kernels::CellRow& row,
                  std::int32_t* winners, float* best, float* confidence);

/// Last stage: selects in each column the candidate with a partner whose cell is best (smallest
/// energy, largest probability), ties going to the smallest candidate, and optionally refines it by
/// a parabola (§3; through −log p for probabilities). Input cells are float, geometry.lanes() per
/// column, finite where a candidate has a partner; other lanes are ignored. Throws Error for a
/// requested confidence that such cells do not have.
std::unique_ptr<scheduler::RowStage> make_cell_selection_stage(
    const kernels::CandidateGeometry& geometry, const CellSelectionSettings& settings,
    const MapOutputs& outputs);

}  // namespace vantage
