#include <algorithm>
#include <limits>
#include <utility>

#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/matching/chain/match_chain.h"
#include "engine/matching/costs/cost_table.h"
#include "engine/matching/costs/stage_disparity_prior.h"
#include "engine/matching/costs/stage_displacement_cost.h"
#include "engine/matching/levels/energy_format.h"
#include "engine/matching/levels/stage_block_source.h"
#include "engine/matching/levels/stage_fixed_energies.h"
#include "engine/matching/levels/stage_half_energies.h"
#include "engine/matching/levels/stage_level_likelihoods.h"

// The costs of MatchChain.

namespace vantage {
namespace {

/// Whether energies that coarse levels are made of fit bytes before they are summed up.
bool has_byte_energies(const MethodParameters& parameters, const ChainInput& input) {
  return has_likelihoods(parameters) && cost_of(parameters).byte_energies &&
         parameters.colour == ColourUse::kLuma && input.partners.size() == 1 &&
         input.partners.front().epipolar == nullptr && input.prior_px.empty();
}

/// Cells of all displacements; of_partner makes the stage of one vertical disparity.
template <typename OfPartner>
std::unique_ptr<scheduler::RowStage> of_all_rows(const ChainInput& input, unsigned char padding,
                                                 const OfPartner& of_partner) {
  std::vector<std::unique_ptr<scheduler::RowStage>> of_rows;
  for (int row = 0; row < input.grid->rows; ++row) {
    CostPartner partner = input.partners.front();
    partner.disparity_y_px = input.grid->disparity_y_min + row;
    of_rows.push_back(of_partner(partner));
  }
  return make_displacement_cost_stage(std::move(of_rows), *input.grid, padding);
}

EnergyConversion energy_conversion(const MethodParameters& parameters, const ChainInput& input) {
  const EnergyFormat format(parameters);
  return has_byte_energies(parameters, input)
             ? EnergyConversion(EnergySource::kBytes, format,
                                cost_of(parameters).byte_energies->nats_per_step(parameters))
             : EnergyConversion(EnergySource::kLikelihoods, format);
}

}  // namespace

/// Reduction to the next coarser level.
void MatchChain::add_reduction(const MethodParameters& parameters, const ChainInput& input,
                               const ChainLevel& level) {
  const auto weight = static_cast<float>(parameters.level_weight);
  if (has_byte_energies(parameters, input)) {
    const ByteEnergies& energies = *cost_of(parameters).byte_energies;
    const float step = energies.nats_per_step(parameters);
    auto costs = byte_energies(parameters, input, 0, geometry_.count);
    if (level.reduced_right != nullptr) {
      add(make_pair_energy_reduction_stage(std::move(costs), geometry_,
                                           energies.without_partner(parameters), step, weight,
                                           {*level.reduced, *level.reduced_right}));
      return;
    }
    add(std::move(costs));
    add(make_byte_energy_reduction_stage(geometry_, step, weight, *level.reduced));
    return;
  }
  add(plain_costs(parameters, input, 0, geometry_.count));
  add(has_likelihoods(parameters)
          ? make_likelihood_reduction_stage(geometry_, weight, *level.reduced)
          : make_half_energy_reduction_stage(geometry_, half_scale_, *level.reduced));
}

/// First stage of the level: costs of the images, or stored costs of the level.
void MatchChain::add_costs(const MethodParameters& parameters, const ChainInput& input,
                           const ChainLevel& level) {
  if (level.costs != nullptr) {
    add(level_costs(parameters, level));
    return;
  }
  if (level.blocks == nullptr) {
    add(costs_of(parameters, input));
    return;
  }
  std::vector<std::unique_ptr<scheduler::RowStage>> of_blocks;
  for (int first = 0; first < geometry_.count; first += kernels::kLaneMultiple) {
    of_blocks.push_back(energy_costs(parameters, input, first,
                                     std::min(kernels::kLaneMultiple, geometry_.count - first)));
  }
  add(make_block_source_stage(std::move(of_blocks), energy_conversion(parameters, input),
                              geometry_.count, *level.blocks));
}

std::unique_ptr<scheduler::RowStage> MatchChain::level_costs(const MethodParameters& parameters,
                                                             const ChainLevel& level) const {
  if (!has_likelihoods(parameters)) {
    return make_level_half_energy_stage(geometry_, half_scale_, *level.costs);
  }
  if (uses_fixed_energies(parameters)) {
    return make_level_fixed_energy_stage(geometry_, *level.costs, EnergyFormat(parameters),
                                         level.blocks);
  }
  return make_level_likelihood_stage(geometry_, *level.costs);
}

/// Costs of the images for some of the candidates: energies, or likelihoods for Bayesian diffusion.
std::unique_ptr<scheduler::RowStage> MatchChain::plain_costs(const MethodParameters& parameters,
                                                             const ChainInput& input,
                                                             int first_candidate, int count) const {
  const CellMeaning meaning =
      has_likelihoods(parameters) ? CellMeaning::kLikelihood : CellMeaning::kEnergy;
  if (input.grid != nullptr) {
    // Evidence is relative to that of all candidates.
    const bool is_relative = is_evidence(parameters) && meaning == CellMeaning::kLikelihood;
    auto costs = of_all_rows(input, 0, [&](const CostPartner& partner) {
      return make_cost_stage(parameters, input.grid->along_rows, *input.reference, {&partner, 1},
                             is_relative ? CellMeaning::kEnergy : meaning, height_);
    });
    return is_relative ? make_displacement_evidence_stage(std::move(costs), *input.grid, parameters)
                       : std::move(costs);
  }
  auto costs = make_cost_stage(parameters, of_candidates(first_candidate, count), *input.reference,
                               input.partners, meaning, height_);
  if (!input.prior_px.empty()) {
    costs = make_disparity_prior_stage(std::move(costs), geometry_, meaning,
                                       {.prior_px = input.prior_px,
                                        .weight = static_cast<float>(input.prior_weight),
                                        .max_contrast = cost_of(parameters).max_contrast,
                                        .first_candidate = first_candidate});
  }
  return costs;
}

/// Costs of all candidates as the cell type that the method aggregates.
std::unique_ptr<scheduler::RowStage> MatchChain::costs_of(const MethodParameters& parameters,
                                                          const ChainInput& input) const {
  if (!uses_fixed_energies(parameters)) {
    return plain_costs(parameters, input, 0, geometry_.count);
  }
  return make_fixed_energy_stage(energy_costs(parameters, input, 0, geometry_.count),
                                 energy_conversion(parameters, input), geometry_.count);
}

/// Costs from which energy_conversion() makes fixed-point energies.
std::unique_ptr<scheduler::RowStage> MatchChain::energy_costs(const MethodParameters& parameters,
                                                              const ChainInput& input,
                                                              int first_candidate,
                                                              int count) const {
  return has_byte_energies(parameters, input)
             ? byte_energies(parameters, input, first_candidate, count)
             : plain_costs(parameters, input, first_candidate, count);
}

/// Only if has_byte_energies().
std::unique_ptr<scheduler::RowStage> MatchChain::byte_energies(const MethodParameters& parameters,
                                                               const ChainInput& input,
                                                               int first_candidate,
                                                               int count) const {
  const auto make_stage = cost_of(parameters).byte_energies->make_stage;
  if (input.grid == nullptr) {
    return make_stage(parameters, of_candidates(first_candidate, count), *input.reference,
                      input.partners.front(), height_);
  }
  return of_all_rows(
      input, std::numeric_limits<unsigned char>::max(), [&](const CostPartner& partner) {
        return make_stage(parameters, input.grid->along_rows, *input.reference, partner, height_);
      });
}

kernels::CandidateGeometry MatchChain::of_candidates(int first_candidate, int count) const {
  kernels::CandidateGeometry candidates = geometry_;
  candidates.disparity_min += first_candidate;
  candidates.count = count;
  return candidates;
}

}  // namespace vantage
