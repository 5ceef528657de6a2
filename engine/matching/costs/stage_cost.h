#pragma once

#include <memory>
#include <span>

#include "engine/matching/costs/cost_image.h"
#include "engine/matching/parameters/method_parameters.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// What the cells of a cost stage hold.
enum class CellMeaning {
  kEnergy,      ///< the cost, small = similar
  kLikelihood,  ///< p0 up to a factor per column, in (0, 1], large = similar (6.25)
};

/// Source stage: the disparity space E0 of (6.1), or the likelihood that Bayesian diffusion starts
/// from. Output cells are float, geometry.lanes() per column; lanes beyond geometry.count are
/// finite (energies) or 0 (likelihoods).
///
/// Energies and likelihoods are those of the cost (CostModel). A cell whose partner is outside has
/// the cost at the clamped coordinate, or the value that the cost defines for such cells. Several
/// partners (at most kernels::kMaxPartners): the better half of those that see the candidate, see
/// kernels/partner_choice.
///
/// `reference`, prepared as a reference, `partners` (at least one), prepared as partners of this
/// direction, and their planes must outlive the stage; all prepared with `parameters`, this range
/// and equal sizes. With a colour image, a grey one has the same intensity in all channels. Throws
/// UsageError for a baseline ratio out of range.
std::unique_ptr<scheduler::RowStage> make_cost_stage(const MethodParameters& parameters,
                                                     const kernels::CandidateGeometry& geometry,
                                                     const CostImage& reference,
                                                     std::span<const CostPartner> partners,
                                                     CellMeaning meaning, int height);

}  // namespace vantage
