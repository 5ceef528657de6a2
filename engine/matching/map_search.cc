#include "engine/matching/map_search.h"
#include "engine/matching/chain/candidate_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "engine/error.h"
#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/matching/costs/displacement_grid.h"
#include "engine/matching/levels/level_extents.h"
#include "scheduler/strip_pipeline.h"

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

}  // namespace

scheduler::ChainPlan chain_plan(const MatchChain& chain, const ExecutionOptions& execution,
                                int threads, const scheduler::Machine& machine) {
  scheduler::PlanRequest request;
  request.threads = threads;
  request.strip_columns = execution.strip_width_px;
  request.band_rows = execution.band_height_px;
  request.memory_bytes = execution.chain_memory_bytes;
  if (execution.iterations_per_pass) {
    request.pass_ends = chain.pass_ends(*execution.iterations_per_pass);
  }
  return scheduler::plan_chain(chain.stages(), machine, request);
}

namespace {

/// `rows` of the last stage, in strips about as wide as those of `plan`, but in one pass.
std::vector<scheduler::Region> strips_of(scheduler::Chain chain, scheduler::Range rows,
                                         const scheduler::ChainPlan& plan) {
  int reach = 0;
  for (const scheduler::RowReach& of_stage : scheduler::row_reaches(chain)) {
    reach += of_stage.below;
  }
  constexpr int kColumnsPerReach = 12;  // columns of both halos are a sixth
  int columns = kColumnsPerReach * reach;
  for (const scheduler::PassPlan& pass : plan.passes) {
    columns = std::max(columns, pass.strip_columns);
  }
  std::vector<scheduler::Region> strips;
  const int width = chain.back()->extent().columns;
  for (int x = 0; x < width; x += columns) {
    strips.push_back({{x, std::min(x + columns, width)}, rows});
  }
  return strips;
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

void MapSearch::compute(Side reference, const ChainInput& input, const MapOutputs& outputs,
                        const CoarseMap& coarse, const CheckMap& check,
                        std::span<const VolumeRequest> volumes, const SearchedParts* parts) {
  const int width = outputs.disparity_px.width();
  const int height = outputs.disparity_px.height();
  const auto grid = displacement_grid(options_, reference, width, height);
  ChainInput searched = input;
  const kernels::CandidateGeometry along_rows =
      seen_by_any(candidate_geometry(options_, reference, width, height), input.partners);
  kernels::CandidateGeometry geometry = along_rows;
  if (grid) {
    searched.grid = &*grid;
    geometry = grid->columns();
  }
  search(geometry, searched, outputs, coarse, check,
         start_writers(reference, {width, height}, along_rows, volumes), parts);
  if (geometry.steps_per_px > 1) {
    const bool has_own_map = !coarse.is_only && !check.is_only;
    for (const ImageView<float>& map :
         {has_own_map ? outputs.disparity_px : ImageView<float>(), check.disparity_px}) {
      convert_to_px(map, geometry.steps_per_px, execution_);
    }
  }
}

void MapSearch::search(const kernels::CandidateGeometry& geometry, const ChainInput& searched,
                       const MapOutputs& outputs, const CoarseMap& coarse, const CheckMap& check,
                       const std::vector<VolumeWriter>& writers, const SearchedParts* parts) {
  const double candidates = candidate_count(options_.disparities, parameters_) *
                            (options_.disparities_y ? options_.disparities_y->count() : 1.0);
  const double pixels =
      static_cast<double>(outputs.disparity_px.width()) * outputs.disparity_px.height();
  if (parameters_.levels == 1) {
    if (const auto* const costs = find_writer(writers, VolumeKind::kCosts, 0)) {
      run_chain(MatchChain(parameters_, geometry, searched, outputs, {.volume = costs}));
    }
    run_chain(MatchChain(parameters_, geometry, searched, outputs,
                         {.volume = find_writer(writers, VolumeKind::kAggregated, 0)}));
    report_.finest_pixels += pixels;
    report_.cells += pixels * candidates;
    report_.finest_cells += pixels * candidates;
    return;
  }
  scheduler::ChainPlan plan_before = report_.plan;
  const bool makes_costs = searched.sharing != CostSharing::kUses;
  scheduler::ChainPlan plan_of_costs = makes_costs ? scheduler::ChainPlan() : plan_before;
  const LevelCells cells = match_coarse_to_fine(
      parameters_, geometry, searched, outputs, work_.levels, execution_,
      [&, is_first = makes_costs](const MatchChain& chain) mutable {
        run_chain(chain);
        if (is_first) {
          plan_of_costs = report_.plan;
          is_first = false;
        }
      },
      coarse, check, writers, parts);
  report_.cells += cells.all_levels;
  if (coarse.is_only) {
    if (!plan_before.passes.empty()) {
      report_.plan = std::move(plan_before);
    }
    return;
  }
  // Windows have no chain. Costs of parts have no plan.
  if (parameters_.window_levels > 0 && !plan_of_costs.passes.empty()) {
    report_.plan = std::move(plan_of_costs);
  }
  report_.finest_cells += cells.finest_level;
  report_.finest_pixels += pixels * (parts != nullptr ? parts->map.share() : 1);
}

/// One writer for all volumes of the same cells.
std::vector<VolumeWriter> MapSearch::start_writers(Side reference, scheduler::Extent image,
                                                   const kernels::CandidateGeometry& along_rows,
                                                   std::span<const VolumeRequest> volumes) const {
  std::vector<VolumeWriter> writers;
  std::map<std::pair<int, VolumeKind>, std::vector<VolumeSink*>> sinks;
  const auto levels = static_cast<int>(level_extents(image, parameters_.levels).size());
  for (const VolumeRequest& volume : volumes) {
    if (volume.side != reference) {
      continue;
    }
    if (volume.level < 0 || volume.level >= levels) {
      throw UsageError(fmt::format(
          "volume-level is {}, expected 0 to {}: images of {}x{} have {} level{} here",
          volume.level, levels - 1, image.columns, image.rows, levels, levels == 1 ? "" : "s"));
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
        VolumeWriter::Space{
            .geometry = along_rows,
            .grid = displacement_grid(options_, reference, image.columns, image.rows),
            .height_px = image.rows,
            .level = level,
            .margin_px = has_whole_windows ? parameters_.window_px / 2 : 0,
            .kind = kind,
            .content = is_aggregated && has_likelihoods(parameters_) ? VolumeContent::kProbabilities
                                                                     : VolumeContent::kEnergies},
        of_cells);
    writers.back().start();
  }
  return writers;
}

void MapSearch::run_chain(const MatchChain& chain) {
  if (chain.regions() != nullptr) {
    scheduler::run_regions(chain.stages(), *chain.regions(), execution_.executor(),
                           execution_.scratch());
    return;
  }
  report_.plan = chain_plan(chain, execution_.options(), execution_.executor().thread_count(),
                            execution_.machine());
  if (chain.rows()) {
    scheduler::run_regions(chain.stages(), strips_of(chain.stages(), *chain.rows(), report_.plan),
                           execution_.executor(), execution_.scratch());
    return;
  }
  scheduler::run_strips(chain.stages(), report_.plan, execution_.executor(), execution_.scratch());
}

}  // namespace vantage
