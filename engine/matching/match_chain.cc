#include "engine/matching/match_chain.h"
#include "engine/matching/levels/level_extents.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "engine/error.h"
#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/matching/aggregation/stage_column_ssd.h"
#include "engine/matching/aggregation/stage_column_sum.h"
#include "engine/matching/costs/cost_table.h"
#include "engine/matching/costs/stage_disparity_prior.h"
#include "engine/matching/costs/stage_displacement_cost.h"
#include "engine/matching/levels/energy_format.h"
#include "engine/matching/levels/stage_block_source.h"
#include "engine/matching/levels/stage_fixed_energies.h"
#include "engine/matching/levels/stage_half_energies.h"
#include "engine/matching/levels/stage_level_likelihoods.h"
#include "engine/matching/selection/stage_cell_selection.h"
#include "engine/matching/selection/stage_coarser_selection.h"
#include "engine/matching/selection/stage_displacement_selection.h"
#include "engine/matching/selection/stage_fixed_energy_selection.h"
#include "engine/matching/selection/stage_scanline_selection.h"
#include "engine/matching/selection/stage_symmetric_selection.h"
#include "engine/matching/selection/stage_window_selection.h"
#include "engine/matching/volume/stage_volume.h"

namespace vantage {

bool uses_column_ssd(const MethodParameters& parameters) {
  return cost_of(parameters).has_column_sums && aggregation_of(parameters).has_windows &&
         parameters.colour == ColourUse::kLuma && parameters.levels == 1 &&
         !parameters.match_exposure && steps_per_px(parameters) == 1;
}

bool can_share_costs(const MethodParameters& parameters) {
  return has_likelihoods(parameters) && parameters.levels > 1 &&
         cost_of(parameters).byte_energies && parameters.colour == ColourUse::kLuma &&
         steps_per_px(parameters) == 1;
}

bool shares_costs(const MethodParameters& parameters, const ChainInput& input,
                  scheduler::Extent image, int candidates) {
  const scheduler::Extent level = coarser_extent(image);
  const double stored_bytes = 0.5 * candidates * level.columns * level.rows;
  return can_share_costs(parameters) && stored_bytes <= kMaxSharedCostBytes &&
         input.partners.size() == 1 && input.prior_px.empty() &&
         input.partners.front().baseline_ratio == 1 && input.grid == nullptr;
}

namespace {

/// Half the number of index bits that fit below the sums of an 8-bit window within 31 bits, or 0.
/// Half, because scaling the intensities makes room for them.
int index_shift(int window_px, const kernels::CandidateGeometry& geometry) {
  constexpr double largest_square = 255.0 * 255.0;
  int shift = 0;
  while ((1 << (2 * shift)) < geometry.lanes()) {
    ++shift;
  }
  const double largest_cell = (window_px * window_px * largest_square + 1) * (1 << (2 * shift));
  return largest_cell < std::numeric_limits<std::int32_t>::max() ? shift : 0;
}

ConfidenceMeasure confidence_measure(const MethodParameters& parameters) {
  if (const auto confidence = aggregation_of(parameters).confidence) {
    return confidence(parameters);
  }
  return is_evidence(parameters) ? ConfidenceMeasure::kEvidence : ConfidenceMeasure::kMargin;
}

/// Bounds of the costs of `input`, including the prior's term.
CostBounds bounds_of(const MethodParameters& parameters, const ChainInput& input) {
  CostBounds bounds = cost_bounds(parameters, static_cast<int>(input.partners.size()));
  if (!input.prior_px.empty()) {
    bounds.max += static_cast<float>(input.prior_weight) * (bounds.max - bounds.min);
  }
  return bounds;
}

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

/// Whether the level selects from the energies of the coarser one as they are.
bool repeats_coarser(const MethodParameters& parameters, const ChainInput& input,
                     const ChainLevel& level) {
  return uses_fixed_energies(parameters) && parameters.selection == Selection::kWinner &&
         input.grid == nullptr && level.coarser != nullptr && level.result == nullptr &&
         level.volume == nullptr && at_level(parameters, level.number).iterations == 0;
}

WindowSelectionSettings window_selection(const MethodParameters& parameters,
                                         const ChainLevel& level) {
  WindowSelectionSettings settings;
  settings.radius = parameters.window_px / 2;
  settings.border = parameters.border;
  settings.subpixel = parameters.subpixel;
  settings.confidence = confidence_measure(parameters);
  settings.entropy_scale = entropy_scale(parameters);
  settings.volume = level.volume;
  return settings;
}

}  // namespace

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
  if (repeats_coarser(parameters, input, level)) {
    add(make_coarser_selection_stage(
        geometry_, height_, energy_selector(parameters), EnergyFormat(parameters),
        {.volume = level.coarser, .blocks = level.coarser_blocks}, level.blocks));
    if (regions_) {  // that stage's rows and columns are those of the coarser level
      for (scheduler::Region& region : *regions_) {
        region = {{region.columns.begin / 2, (region.columns.end + 1) / 2},
                  {region.rows.begin / 2, (region.rows.end + 1) / 2}};
      }
    }
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

EnergySelector MatchChain::energy_selector(const MethodParameters& parameters) const {
  return {parameters.subpixel, EnergyFormat(parameters).steps_per_nat(), outputs_};
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
    costs = make_disparity_prior_stage(std::move(costs), geometry_, meaning, input.prior_px,
                                       static_cast<float>(input.prior_weight),
                                       cost_of(parameters).max_contrast, first_candidate);
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

void MatchChain::add_column_ssd(const MethodParameters& parameters, const ChainInput& input,
                                const ChainLevel& level) {
  const PreparedPair& pair = *input.pair;
  const bool left = geometry_.direction < 0;
  WindowSelectionSettings settings = window_selection(parameters, level);
  const auto add_stages = [&](const auto& planes, auto... shift) {
    add(make_column_ssd_stage(left ? planes.left : planes.right,
                              left ? planes.right_mirrored : planes.left, geometry_, height_,
                              settings.radius, shift...));
  };
  if (pair.is_8_bit) {
    const int shift = index_shift(parameters.window_px, geometry_);
    settings.index_bits = 2 * shift;
    add_stages(pair.grey_8, shift);
  } else {
    settings.energy_scale = pair.cost_unit;
    add_stages(pair.grey_float);
  }
  add_window_selection(parameters, settings, input);
}

void MatchChain::add_box(const MethodParameters& parameters, const ChainInput& input,
                         const ChainLevel& level) {
  const CostBounds bounds = bounds_of(parameters, input);
  const ColumnSumScale quantised = column_sum_scale(bounds.min, bounds.max, parameters.window_px);
  WindowSelectionSettings settings = window_selection(parameters, level);
  settings.energy_scale = 1.0F / quantised.scale;
  settings.energy_offset = quantised.offset;
  if (input.grid != nullptr) {
    add(make_displacement_sum_stage(*input.grid, settings.radius, quantised.offset,
                                    quantised.scale));
    add(make_displacement_window_selection_stage(*input.grid, settings, outputs_));
    return;
  }
  add(make_column_sum_stage(geometry_, height_, settings.radius, quantised.offset,
                            quantised.scale));
  add_window_selection(parameters, settings, input);
}

void MatchChain::add_window_selection(const MethodParameters& parameters,
                                      const WindowSelectionSettings& settings,
                                      const ChainInput& input) {
  add(parameters.selection == Selection::kWinner
          ? make_window_selection_stage(geometry_, settings, outputs_)
          : row_selection(parameters, input, make_window_energies(geometry_, height_, settings)));
}

std::unique_ptr<scheduler::RowStage> MatchChain::row_selection(
    const MethodParameters& parameters, const ChainInput& input,
    std::unique_ptr<RowEnergies> energies) const {
  const ConfidenceMeasure confidence = confidence_measure(parameters);
  const auto scale = static_cast<float>(entropy_scale(parameters));
  if (parameters.selection == Selection::kScanline) {
    return make_scanline_selection_stage(
        std::move(energies),
        {.jump = {static_cast<float>(parameters.jump_penalty * parameters.candidate_step_px),
                  static_cast<float>(parameters.jump_limit)},
         .subpixel = parameters.subpixel,
         .confidence = confidence,
         .entropy_scale = scale},
        outputs_);
  }
  static const LevelVolume never_read;
  const SymmetricPlace place = input.symmetric != nullptr ? *input.symmetric : SymmetricPlace{};
  // Energies of Bayes are −ln p.
  const double min = has_likelihoods(parameters) ? 0 : bounds_of(parameters, input).min;
  const EnergySteps steps = EnergySteps::of(min, parameters.occlusion_penalty, geometry_.width);
  if (place.right != nullptr && !place.is_stored) {
    return make_symmetric_store_stage(std::move(energies), steps, *place.right);
  }
  return make_symmetric_selection_stage(std::move(energies),
                                        place.right != nullptr ? *place.right : never_read,
                                        {.steps = steps,
                                         .subpixel = parameters.subpixel,
                                         .confidence = confidence,
                                         .entropy_scale = scale},
                                        outputs_, place.right_outputs);
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

void MatchChain::add_selection(const MethodParameters& parameters, const ChainInput& input,
                               const ChainLevel& level) {
  if (parameters.selection != Selection::kWinner) {
    add_last(
        parameters, level,
        row_selection(parameters, input,
                      uses_fixed_energies(parameters)
                          ? make_fixed_energies(geometry_, EnergyFormat(parameters).steps_per_nat())
                          : make_cell_energies(geometry_, has_likelihoods(parameters))));
    return;
  }
  if (uses_fixed_energies(parameters)) {
    if (input.grid != nullptr) {
      add_last(parameters, level,
               make_displacement_fixed_energy_selection_stage(
                   *input.grid, parameters.subpixel, EnergyFormat(parameters).steps_per_nat(),
                   outputs_));
      return;
    }
    add_last(parameters, level,
             make_fixed_energy_selection_stage(geometry_, height_, energy_selector(parameters),
                                               level.blocks));
    return;
  }
  CellSelectionSettings settings;
  settings.cells_are_probabilities = has_likelihoods(parameters);
  settings.subpixel = parameters.subpixel;
  settings.confidence = confidence_measure(parameters);
  settings.entropy_scale = static_cast<float>(entropy_scale(parameters));
  add_last(parameters, level,
           input.grid != nullptr
               ? make_displacement_selection_stage(*input.grid, settings, outputs_)
               : make_cell_selection_stage(geometry_, settings, outputs_));
}

}  // namespace vantage
