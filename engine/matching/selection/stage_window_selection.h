#pragma once

#include <memory>

#include "engine/matching/parameters/method_parameters.h"
#include "engine/matching/selection/stage_cell_selection.h"
#include "engine/matching/volume/volume_writer.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// How winners are selected from column sums and converted to disparities.
struct WindowSelectionSettings {
  int radius = 0;  ///< of the window: 0 for single columns
  /// If not 0, column sums are multiples of 2^index_bits, which exceeds every candidate's index,
  /// and window sums stay below 2³¹: cells can then carry the index of their candidate.
  int index_bits = 0;
  Border border = Border::kClip;
  Subpixel subpixel = Subpixel::kParabola;

  /// Meaning of sums: energy = mean over the samples · energy_scale − energy_offset, where the mean
  /// is that of a window's sum without index bits. energy_scale > 0.
  double energy_scale = 1;
  double energy_offset = 0;
  ConfidenceMeasure confidence = ConfidenceMeasure::kMargin;  ///< not kProbability
  double entropy_scale = 1;                                   ///< see CellSelectionSettings

  const VolumeWriter* volume =
      nullptr;  ///< takes the energies of all candidates; outlives the stage
};

/// Last stage: sums column sums over 2·radius + 1 columns, cut to the image, selects the candidate
/// with the smallest mean cost per pixel, ties going to the smallest candidate, and optionally
/// refines it by a parabola (§1, §3); NaN where there is no candidate. Input cells are int32_t ≥ 0,
/// geometry.lanes() per column. Sum and selection are one stage because the sums then stay in
/// registers if only the winner is needed. Energy and confidence are computed only if requested,
/// from mean costs over the eligible candidates. Throws Error for a confidence that energies do not
/// have.
std::unique_ptr<scheduler::RowStage> make_window_selection_stage(
    const kernels::CandidateGeometry& geometry, const WindowSelectionSettings& settings,
    const MapOutputs& outputs);

}  // namespace vantage
