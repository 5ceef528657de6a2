#pragma once

#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/matching/aggregation/edge_weights.h"
#include "engine/matching/costs/cost_image.h"
#include "engine/matching/parameters/method_parameters.h"
#include "engine/matching/windows/coarse_beliefs.h"
#include "kernels/candidates.h"
#include "scheduler/range.h"

namespace vantage {

/// Input of a level of windows. All must outlive the call.
struct WindowLevelInput {
  /// Iterations (at least 1), prior and measurement of the level, see at_level().
  const MethodParameters& parameters;
  /// Pixels of a column along one direction, 1 or 2.
  int side = 2;
  /// Candidates from one candidate of `coarse` to the next, 1 or 2.
  int spacing = 2;
  /// Candidates of the pixels whose codes are compared: side times as wide and high as the level.
  /// Both images are prepared with the parameters' cost for window_margins() of it.
  kernels::CandidateGeometry geometry;
  const CostImage& reference;
  const CostImage& partner;
  const EdgeWeights* edges;  ///< of the level, for final_iterations; null: all weights are 1
  const CoarseBeliefs& coarse;
  /// Disparities that attract pixels, on the reference's grid; empty: none. See
  /// kernels/disparity_prior.
  ImageView<const float> prior_px = {};
  double prior_weight = 0;
};

/// The geometry for which the images of a level are prepared: with enough columns on both sides.
kernels::CandidateGeometry window_margins(kernels::CandidateGeometry geometry);

/// Columns and rows of the coarser level that search_windows() reads around those of a region.
int coarse_reach(int iterations);

/// Output of a level of windows; images have the level's size.
struct WindowLevelOutput {
  /// Disparities of the winners in pixels of `geometry`, NaN where no candidate has a partner.
  ImageView<float> disparity_px;
  /// Probability of the winner among the candidates of its window; empty: not requested.
  ImageView<float> confidence = {};
  WindowState* state = nullptr;  ///< for a finer level; null: not requested
  /// Parts of the level to search, which do not overlap; other pixels are not written. Null: all.
  const std::vector<scheduler::Region>* regions = nullptr;
};

/// Bayesian diffusion over windows of candidates (EQUATIONS §3.13): each pixel of the level, which
/// stands for side² pixels of the images, searches 8 candidates around the winner of the coarser
/// level's pixel that covers it, and where winners around that differ, 8 around another of them.
/// The start is the coarser level's result. Rows are swept in bands; nothing but the result is
/// stored. Identical for any `execution`; a pixel does not depend on which others are searched.
void search_windows(const WindowLevelInput& input, Subpixel subpixel,
                    const WindowLevelOutput& output, Execution& execution);

}  // namespace vantage
