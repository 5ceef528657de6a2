#pragma once

#include <memory>

#include "engine/matching/options/method_parameters.h"
#include "engine/matching/selection/stage_cell_selection.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// How winners are chosen from column sums and turned into disparities.
struct WindowSelectionSettings {
  int radius = 0;  ///< of the window: 0 for single columns
  /// When not 0, column sums are multiples of 2^index_bits, which exceeds every candidate's index,
  /// and sums of windows stay below 2³¹: cells can then carry the index of their candidate.
  int index_bits = 0;
  Border border = Border::kClip;
  Subpixel subpixel = Subpixel::kParabola;

  /// What sums mean: energy = mean over the samples · energy_scale − energy_offset, the mean being
  /// that of a window's sum freed of index bits. energy_scale > 0.
  double energy_scale = 1;
  double energy_offset = 0;
  ConfidenceMeasure confidence = ConfidenceMeasure::kMargin;  ///< not kProbability
  double entropy_scale = 1;                                   ///< see CellSelectionSettings
};

/// Last stage: sums column sums over 2·radius + 1 columns, cut to the image, chooses the candidate
/// with the least mean cost per pixel, the smallest of equals, and optionally refines it by a
/// parabola (§1, §3); NaN where there is no candidate. Input cells are int32_t ≥ 0,
/// geometry.lanes() a column. Sum and selection are one stage because for a winner alone the sums
/// need never leave the registers.
/// Energy and confidence, computed only if wanted, are those of mean costs over the candidates that
/// may win. Throws Error for a confidence that energies do not have.
std::unique_ptr<scheduler::RowStage> make_window_selection_stage(
    const kernels::CandidateGeometry& geometry, const WindowSelectionSettings& settings,
    const MapOutputs& outputs);

}  // namespace vantage
