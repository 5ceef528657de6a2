#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "engine/matching/aggregation/aggregation_place.h"
#include "engine/matching/costs/stage_cost.h"
#include "engine/matching/levels/stage_half_energies.h"
#include "engine/matching/parameters/method_parameters.h"
#include "engine/matching/selection/stage_cell_selection.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Reach of an aggregation, in its own unit.
struct AggregationReach {
  double amount = 0;
  std::string_view unit;
};

/// An aggregation: everything known about it outside its stages.
struct CellAggregation {
  Aggregation key = Aggregation::kNone;
  std::string_view name;         ///< in options, messages and tuning keys
  std::string_view description;  ///< one line of help
  /// Options that it reads; some only with levels or other options (parameter_readers.h).
  std::vector<std::string_view> options;

  /// Default cost, and what the cells of that cost mean.
  MatchCost natural_cost = MatchCost::kSquared;
  CellMeaning cells = CellMeaning::kEnergy;
  bool is_iterative = false;  ///< `iterations` stages, preceded by initial ones
  /// Has windows: on the finest level, selection sums them in integers.
  bool has_windows = false;
  CoarserUse coarser_use = CoarserUse::kSupport;  ///< use of the energies of a coarser level

  /// Null: no reach beyond the pixel.
  AggregationReach (*reach)(const MethodParameters& parameters) = nullptr;
  /// Null: the margin of energies; for costs that are evidence, the evidence.
  ConfidenceMeasure (*confidence)(const MethodParameters& parameters) = nullptr;
  /// `parameters`: of the level. Null: no stages.
  std::vector<std::unique_ptr<scheduler::RowStage>> (*make_stages)(
      const MethodParameters& parameters, const AggregationPlace& place) = nullptr;

  [[nodiscard]] bool reads(std::string_view option) const {
    return std::find(options.begin(), options.end(), option) != options.end();
  }
};

/// All aggregations, in the order of help texts. Command line, validation, messages, tuning keys
/// and tests read this table.
std::span<const CellAggregation> aggregation_table();

/// The entry of one aggregation.
const CellAggregation& aggregation_of(Aggregation aggregation);
inline const CellAggregation& aggregation_of(const MethodParameters& parameters) {
  return aggregation_of(parameters.aggregation);
}

/// Whether cells are likelihoods and probabilities rather than energies.
inline bool has_likelihoods(const MethodParameters& parameters) {
  return aggregation_of(parameters).cells == CellMeaning::kLikelihood;
}

}  // namespace vantage
