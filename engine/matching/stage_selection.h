#pragma once

#include <memory>

#include "engine/image/image.h"
#include "engine/matching/match_options.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// How winners are chosen from summed costs and turned into disparities.
struct SelectionSettings {
  int window_radius = 0;  ///< of the sums: 0 for single samples
  int index_bits = 0;     ///< cells are sum · 2^index_bits + candidate index; 0 for plain sums
  Border border = Border::kClip;
  Subpixel subpixel = Subpixel::kParabola;
};

/// Last stage: the candidate with the least mean cost per pixel, the smallest of equals, optionally
/// refined by a parabola (§1, §3); NaN where there is no candidate. Input cells are int32_t ≥ 0.
/// Writes into `disparity_px` (geometry.width wide), which must outlive the stage.
std::unique_ptr<scheduler::RowStage> make_selection_stage(
    const kernels::CandidateGeometry& geometry, const SelectionSettings& settings,
    ImageView<float> disparity_px);

}  // namespace vantage
