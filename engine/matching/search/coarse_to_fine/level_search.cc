#include "engine/matching/search/coarse_to_fine/level_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "engine/error.h"
#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/matching/chain/candidate_geometry.h"
#include "engine/matching/chain/chain_run.h"
#include "engine/matching/levels/level_extents.h"

namespace vantage {
namespace {

/// Chains make maps in candidates.
void convert_to_px(ImageView<float> map, int steps_per_px, Execution& execution) {
  const float px_per_step = 1.0F / static_cast<float>(steps_per_px);
  execution.for_each_band(map.height(), [&](int first_row, int end_row) {
    for (int y = first_row; y < end_row; ++y) {
      for (int x = 0; x < map.width(); ++x) {
        map.row(y)[x] *= px_per_step;
      }
    }
  });
}

/// `geometry` with the candidates that any of `partners` sees.
kernels::CandidateGeometry seen_by_any(kernels::CandidateGeometry geometry,
                                       std::span<const CostPartner> partners) {
  for (const CostPartner& partner : partners) {
    const double ratio = partner.baseline_ratio;
    if (partner.epipolar != nullptr) {
      // Which candidates have a partner differs from pixel to pixel; costs know.
      constexpr double kAll = 1e-12;
      geometry.near_ratio = kAll;
    } else if (ratio > 0) {
      geometry.near_ratio = std::min(geometry.near_ratio, ratio);
    } else {
      geometry.opposite_ratio =
          geometry.opposite_ratio > 0 ? std::min(geometry.opposite_ratio, -ratio) : -ratio;
    }
  }
  return geometry;
}

}  // namespace

LevelSearch::Candidates LevelSearch::candidates_of(Side reference, const ChainInput& input,
                                                   scheduler::Extent image) const {
  return {.along_rows = seen_by_any(
              candidate_geometry(options_, reference, image.columns, image.rows), input.partners),
          .grid = displacement_grid(options_, reference, image.columns, image.rows)};
}

void LevelSearch::compute(Side reference, const ChainInput& input, const WantedWinners& wanted,
                          std::span<const VolumeRequest> volumes) {
  const ImageView<float> map_px = wanted.outputs.disparity_px;
  const Candidates candidates = candidates_of(reference, input, {map_px.width(), map_px.height()});
  const kernels::CandidateGeometry geometry = candidates.geometry();
  ChainInput searched = input;
  searched.grid = candidates.grid ? &*candidates.grid : nullptr;
  search({parameters_, geometry, searched}, wanted,
         start_writers(reference, candidates, map_px.height(), volumes));
  if (geometry.steps_per_px > 1) {
    const bool has_own_map = wanted.coarse.level == 0 && !wanted.check.is_only;
    for (const ImageView<float>& map :
         {has_own_map ? map_px : ImageView<float>(), wanted.check.disparity_px}) {
      convert_to_px(map, geometry.steps_per_px, execution_);
    }
  }
}

void LevelSearch::search(const SearchedImage& image, const WantedWinners& wanted,
                         const std::vector<VolumeWriter>& writers) {
  scheduler::ChainPlan plan_before = report_.plan;
  const bool makes_costs = image.input.sharing != CostSharing::kUses;
  scheduler::ChainPlan plan_of_costs = makes_costs ? scheduler::ChainPlan() : plan_before;
  const RunChain run = [&, is_first = makes_costs](const MatchChain& chain) mutable {
    run_chain(chain, execution_, report_.plan);
    if (is_first) {
      plan_of_costs = report_.plan;
      is_first = false;
    }
  };
  const LevelCells cells = CoarseToFine(image, wanted, levels_, execution_, run).search(writers);
  report_.cells += cells.all_levels;
  if (wanted.coarse.level > 0) {
    if (!plan_before.passes.empty()) {
      report_.plan = std::move(plan_before);
    }
    return;
  }
  // Windows have no chain. Costs of parts have no plan.
  if (levels_.plan().has_windows && !plan_of_costs.passes.empty()) {
    report_.plan = std::move(plan_of_costs);
  }
  report_.finest_cells += cells.finest_level;
  report_.finest_pixels += static_cast<double>(wanted.outputs.disparity_px.width()) *
                           wanted.outputs.disparity_px.height() *
                           (wanted.parts != nullptr ? wanted.parts->map.share() : 1);
}

std::vector<scheduler::ChainPlan> LevelSearch::plans(
    Side reference, const ChainInput& input, const MapOutputs& size,
    std::span<const ExecutionOptions> executions) const {
  const scheduler::Extent image{size.disparity_px.width(), size.disparity_px.height()};
  const Candidates candidates = candidates_of(reference, input, image);
  const kernels::CandidateGeometry geometry = candidates.geometry();
  ChainInput searched = input;
  searched.grid = candidates.grid ? &*candidates.grid : nullptr;
  const LevelPlan plan = level_plan(parameters_, image, geometry.count);
  const LevelVolume volume;  // never read
  LevelVolume costs;         // never written
  LevelVolume right_costs;   // likewise
  CandidateBlocks blocks;
  ChainLevel place;
  if (plan.has_windows) {
    place.reduced = &costs;
    place.reduced_right =
        shares_costs(parameters_, searched, image, geometry.count) ? &right_costs : nullptr;
  } else if (plan.coarsest() > 0) {
    place.coarser = &volume;
    if (plan.pruned_levels > 0) {
      blocks.resize(image, plan.candidates, plan.candidate_blocks, plan.steps_per_px);
      place.blocks = &blocks;
    }
  }
  const MatchChain chain(parameters_, geometry, searched, size, place);
  std::vector<scheduler::ChainPlan> plans;
  for (const ExecutionOptions& execution : executions) {
    plans.push_back(chain_plan(chain, execution, thread_count(execution, execution_.machine()),
                               execution_.machine()));
  }
  return plans;
}

/// One writer for all volumes of the same cells.
std::vector<VolumeWriter> LevelSearch::start_writers(Side reference, const Candidates& candidates,
                                                     int height_px,
                                                     std::span<const VolumeRequest> volumes) const {
  std::vector<VolumeWriter> writers;
  std::map<std::pair<int, VolumeKind>, std::vector<VolumeSink*>> sinks;
  const int width_px = candidates.along_rows.width;
  const auto levels =
      static_cast<int>(level_extents({width_px, height_px}, parameters_.levels).size());
  for (const VolumeRequest& volume : volumes) {
    if (volume.side != reference) {
      continue;
    }
    if (volume.level < 0 || volume.level >= levels) {
      throw UsageError(fmt::format(
          "volume-level is {}, expected 0 to {}: images of {}x{} have {} level{} here",
          volume.level, levels - 1, width_px, height_px, levels, levels == 1 ? "" : "s"));
    }
    sinks[{volume.level, volume.kind}].push_back(volume.sink);
  }
  for (const auto& [cells, of_cells] : sinks) {
    const auto [level, kind] = cells;
    const bool is_aggregated = kind == VolumeKind::kAggregated;
    const bool has_whole_windows = is_aggregated && level == 0 &&
                                   aggregation_of(parameters_).has_windows &&
                                   parameters_.border == Border::kValid;
    writers.emplace_back(
        VolumeWriter::Space{.geometry = candidates.along_rows,
                            .grid = candidates.grid,
                            .height_px = height_px,
                            .level = level,
                            .margin_px = has_whole_windows ? parameters_.window_px / 2 : 0,
                            .kind = kind,
                            .content = is_aggregated && has_likelihoods(parameters_)
                                           ? VolumeContent::kProbabilities
                                           : VolumeContent::kEnergies},
        of_cells);
    writers.back().start();
  }
  return writers;
}

}  // namespace vantage
