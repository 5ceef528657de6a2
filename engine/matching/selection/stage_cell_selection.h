#pragma once

#include <memory>

#include "engine/image/image.h"
#include "engine/matching/options/method_parameters.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// How sure a winner is; large = sure.
enum class ConfidenceMeasure {
  kEvidence,     ///< M, the evidence of the winner (5.12): −E
  kMargin,       ///< winner margin (6.13)
  kEntropy,      ///< Σ p log p ≤ 0 (6.15)
  kProbability,  ///< max p
};

/// Where a selection stage writes; views of the size of the reference image that outlive it. NaN
/// where there is no candidate. Disparities are always wanted; other views are empty if not.
struct MapOutputs {
  ImageView<float> disparity_px;
  ImageView<float> confidence = {};
  ImageView<float> energy = {};          ///< of the winner: E, or −log p; of a search along rows
  ImageView<float> disparity_y_px = {};  ///< of a search in two dimensions, always wanted there
};

struct CellSelectionSettings {
  /// Cells are probabilities that sum to 1 over a column's candidates and lanes; else energies.
  bool cells_are_probabilities = false;
  Subpixel subpixel = Subpixel::kParabola;
  /// kProbability of probabilities, another of energies.
  ConfidenceMeasure confidence = ConfidenceMeasure::kMargin;
  /// Of the entropy: p ∝ exp(−scale · (E − Emin)), 1/(2σM²).
  float entropy_scale = 1;
};

/// Last stage: chooses in each column the candidate with a partner whose cell is best (least
/// energy, largest probability), the smallest of equals, and optionally refines it by a parabola
/// (§3; through −log p for probabilities). Input cells are float, geometry.lanes() a column, finite
/// where a candidate has a partner; what other lanes hold does not matter. Throws Error for a
/// wanted confidence that such cells do not have.
std::unique_ptr<scheduler::RowStage> make_cell_selection_stage(
    const kernels::CandidateGeometry& geometry, const CellSelectionSettings& settings,
    const MapOutputs& outputs);

}  // namespace vantage
