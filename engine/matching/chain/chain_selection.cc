#include <cstdint>
#include <limits>
#include <utility>

#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/matching/aggregation/stage_column_ssd.h"
#include "engine/matching/aggregation/stage_column_sum.h"
#include "engine/matching/chain/match_chain.h"
#include "engine/matching/costs/cost_table.h"
#include "engine/matching/levels/energy_format.h"
#include "engine/matching/selection/stage_cell_selection.h"
#include "engine/matching/selection/stage_displacement_selection.h"
#include "engine/matching/selection/stage_fixed_energy_selection.h"
#include "engine/matching/selection/stage_scanline_selection.h"
#include "engine/matching/selection/stage_symmetric_selection.h"
#include "engine/matching/selection/stage_window_selection.h"

// The windows and the selection of winners of MatchChain.

namespace vantage {
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
             make_fixed_energy_selection_stage(
                 geometry_, height_,
                 {parameters.subpixel, EnergyFormat(parameters).steps_per_nat(), outputs_},
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
