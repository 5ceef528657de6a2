#include "engine/matching/chain/match_chain.h"

#include <cstddef>
#include <utility>

#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/matching/costs/cost_table.h"
#include "engine/matching/levels/energy_format.h"
#include "engine/matching/levels/level_extents.h"
#include "engine/matching/levels/stage_fixed_energies.h"
#include "engine/matching/levels/stage_half_energies.h"
#include "engine/matching/levels/stage_level_likelihoods.h"
#include "engine/matching/volume/stage_volume.h"

namespace vantage {

bool uses_column_ssd(const MethodParameters& parameters) {
  return cost_of(parameters).has_column_sums && aggregation_of(parameters).has_windows &&
         parameters.colour == ColourUse::kLuma && parameters.levels == 1 &&
         steps_per_px(parameters) == 1;
}

bool can_share_costs(const MethodParameters& parameters, scheduler::Extent image, int candidates) {
  constexpr double kMaxStoredBytes = 32 << 20;
  const scheduler::Extent level = coarser_extent(image);
  const double stored_bytes = 1.0 * candidates * level.columns * level.rows;
  return has_likelihoods(parameters) && parameters.levels > 1 &&
         cost_of(parameters).byte_energies && parameters.colour == ColourUse::kLuma &&
         steps_per_px(parameters) == 1 && stored_bytes <= kMaxStoredBytes;
}

bool shares_costs(const MethodParameters& parameters, const ChainInput& input,
                  scheduler::Extent image, int candidates) {
  return can_share_costs(parameters, image, candidates) && input.partners.size() == 1 &&
         input.prior_px.empty() && input.partners.front().baseline_ratio == 1 &&
         input.grid == nullptr;
}

MatchChain::MatchChain(const MethodParameters& parameters,
                       const kernels::CandidateGeometry& geometry, const ChainInput& input,
                       const MapOutputs& outputs, const ChainLevel& level)
    : geometry_(geometry),
      outputs_(outputs),
      height_(level.costs != nullptr ? level.costs->extent().rows : outputs.disparity_px.height()),
      regions_(level.regions != nullptr ? std::optional(*level.regions) : std::nullopt),
      rows_(level.rows) {
  const bool is_cost_volume = level.volume != nullptr && level.volume->kind() == VolumeKind::kCosts;
  if (input.pair != nullptr && !is_cost_volume) {
    add_column_ssd(parameters, input, level);
    return;
  }
  half_scale_ = half_scale(bounds_of(parameters, input));
  if (is_cost_volume) {
    add_cost_volume(parameters, input, level);
    return;
  }
  if (level.reduced != nullptr) {
    add_reduction(parameters, input, level);
    return;
  }
  add_costs(parameters, input, level);
  if (level.coarser != nullptr && !has_likelihoods(parameters)) {
    add(make_coarser_half_energy_stage(geometry_, height_, aggregation_of(parameters).coarser_use,
                                       half_scale_, *level.coarser));
  }
  if (aggregation_of(parameters).has_windows && level.result == nullptr) {
    add_box(parameters, input, level);
    return;
  }
  add_aggregation(at_level(parameters, level.number), input, level);
  if (level.result != nullptr) {
    add_result(parameters, level);
  } else {
    add_selection(parameters, input, level);
  }
}

/// Bounds of the costs of `input`, including the prior's term.
CostBounds MatchChain::bounds_of(const MethodParameters& parameters, const ChainInput& input) {
  CostBounds bounds = cost_bounds(parameters, static_cast<int>(input.partners.size()));
  if (!input.prior_px.empty()) {
    bounds.max += static_cast<float>(input.prior_weight) * (bounds.max - bounds.min);
  }
  return bounds;
}

std::vector<int> MatchChain::pass_ends(int iterations) const {
  std::vector<int> ends;
  for (int done = iterations; done < iterations_; done += iterations) {
    ends.push_back(first_iteration_ + done);
  }
  return ends;
}

void MatchChain::add(std::unique_ptr<scheduler::RowStage> stage) {
  pointers_.push_back(stage.get());
  stages_.push_back(std::move(stage));
}

void MatchChain::add_all(std::vector<std::unique_ptr<scheduler::RowStage>> stages) {
  for (auto& stage : stages) {
    add(std::move(stage));
  }
}

/// `parameters`: of the level.
void MatchChain::add_aggregation(const MethodParameters& parameters, const ChainInput& input,
                                 const ChainLevel& level) {
  const CellAggregation& aggregation = aggregation_of(parameters);
  if (aggregation.make_stages == nullptr) {
    return;
  }
  AggregationPlace place{.geometry = geometry_,
                         .height = height_,
                         .coarser = level.coarser,
                         .coarser_blocks = level.coarser_blocks,
                         .blocks = level.blocks};
  if (input.grid != nullptr) {
    place.plane = input.grid->plane();
  }
  if (!input.edges.empty() && parameters.iterations > 0) {
    place.edges = &input.edges[static_cast<std::size_t>(level.number)];
  }
  add_all(aggregation.make_stages(parameters, place));
  if (aggregation.is_iterative) {
    iterations_ = parameters.iterations;
    first_iteration_ = static_cast<int>(stages_.size()) - iterations_;
  }
}

/// Costs of all candidates, handed to the level's writer.
void MatchChain::add_cost_volume(const MethodParameters& parameters, const ChainInput& input,
                                 const ChainLevel& level) {
  add_costs(parameters, input, {.costs = level.costs});
  if (uses_fixed_energies(parameters)) {
    add(make_fixed_energy_volume_stage(geometry_, height_, EnergyFormat(parameters).steps_per_nat(),
                                       nullptr, *level.volume));
  } else if (has_likelihoods(parameters)) {
    add(make_likelihood_volume_stage(geometry_, height_, *level.volume));
  } else {
    add(make_value_volume_stage(geometry_, height_, *level.volume));
  }
}

/// Adds the last stage, which hands its cells to the level's writer, too.
void MatchChain::add_last(const MethodParameters& parameters, const ChainLevel& level,
                          std::unique_ptr<scheduler::RowStage> stage) {
  if (level.volume == nullptr) {
    add(std::move(stage));
    return;
  }
  add(make_stage_beside_volume(
      std::move(stage), uses_fixed_energies(parameters)
                            ? make_fixed_energy_volume_stage(
                                  geometry_, height_, EnergyFormat(parameters).steps_per_nat(),
                                  level.blocks, *level.volume)
                            : make_value_volume_stage(geometry_, height_, *level.volume)));
}

void MatchChain::add_result(const MethodParameters& parameters, const ChainLevel& level) {
  const LevelResult result{.cells = level.result, .winners = level.winners};
  if (!has_likelihoods(parameters)) {
    add_last(parameters, level,
             make_half_energy_store_stage(geometry_, half_scale_, *level.result));
  } else if (uses_fixed_energies(parameters)) {
    add_last(parameters, level,
             make_level_fixed_energy_result_stage(geometry_, result, EnergyFormat(parameters),
                                                  level.blocks));
  } else {
    add_last(parameters, level, make_level_probability_stage(geometry_, result));
  }
}

}  // namespace vantage
