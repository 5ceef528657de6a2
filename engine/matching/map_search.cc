#include "engine/matching/map_search.h"

#include <limits>
#include <utility>

#include "engine/matching/winner_merge.h"
#include "scheduler/strip_pipeline.h"

namespace vantage {

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

void MapSearch::compute(Reference reference, const ChainInput& input, const MapResult& result) {
  const auto geometry = candidate_geometry(options_, reference, result.disparity_px->width(),
                                           result.disparity_px->height());
  if (options_.disparities_y) {
    search_rows(geometry, input, result);
    return;
  }
  MapOutputs outputs{.disparity_px = result.disparity_px->view()};
  if (result.confidence != nullptr) {
    outputs.confidence = result.confidence->view();
  }
  run_levels(geometry, input, outputs, result.coarse);
}

/// Vertical disparities one after the other, each like a search along rows between shifted images;
/// of the winners the best is kept (5.5.3).
void MapSearch::search_rows(const kernels::CandidateGeometry& geometry, const ChainInput& input,
                            const MapResult& result) {
  const int width = result.disparity_px->width();
  const int height = result.disparity_px->height();
  constexpr float nothing = std::numeric_limits<float>::quiet_NaN();
  result.disparity_px->fill(nothing);
  result.disparity_y_px->fill(nothing);
  work_.energy.resize(width, height);
  work_.energy.fill(std::numeric_limits<float>::infinity());
  work_.candidate_energy.resize(width, height);
  work_.candidate_disparity_px.resize(width, height);
  MapOutputs outputs{.disparity_px = work_.candidate_disparity_px.view(),
                     .energy = work_.candidate_energy.view()};
  WinnerMerge merge{.candidate_disparity_px = work_.candidate_disparity_px.view(),
                    .candidate_energy = work_.candidate_energy.view(),
                    .disparity_px = result.disparity_px->view(),
                    .disparity_y = result.disparity_y_px->view(),
                    .energy = work_.energy.view()};
  if (result.confidence != nullptr) {
    result.confidence->fill(nothing);
    work_.candidate_confidence.resize(width, height);
    outputs.confidence = work_.candidate_confidence.view();
    merge.candidate_confidence = work_.candidate_confidence.view();
    merge.confidence = result.confidence->view();
  }
  ChainInput shifted = input;
  for (int d = options_.disparities_y->min; d <= options_.disparities_y->max; ++d) {
    for (CostPartner& partner : shifted.partners) {
      partner.disparity_y_px = d;
    }
    run_levels(geometry, shifted, outputs, {});
    merge.disparity_y_px = d;
    execution_.for_each_band(height, [&](int first_row, int end_row) {
      for (int y = first_row; y < end_row; ++y) {
        const int partner_row = y + geometry.direction * d;
        if (partner_row >= 0 && partner_row < height) {
          merge.merge_row(y);
        }
      }
    });
  }
}

/// One map along rows: flat or coarse to fine.
void MapSearch::run_levels(const kernels::CandidateGeometry& geometry, const ChainInput& input,
                           const MapOutputs& outputs, const CoarseMap& coarse_map) {
  const double pixels = static_cast<double>(geometry.width) * outputs.disparity_px.height();
  if (parameters_.levels == 1) {
    run_chain(MatchChain(parameters_, geometry, input, outputs));
    report_.finest_pixels += pixels;
    report_.cells += pixels * options_.disparities.count();
    report_.finest_cells += pixels * options_.disparities.count();
    return;
  }
  scheduler::ChainPlan plan_before = report_.plan;
  const LevelCells cells = match_coarse_to_fine(
      parameters_, geometry, input, outputs, work_.levels, execution_,
      [this](const MatchChain& chain) { run_chain(chain); }, coarse_map);
  report_.cells += cells.all_levels;
  if (coarse_map.is_all) {
    report_.plan = std::move(plan_before);
    return;
  }
  report_.finest_cells += cells.finest_level;
  report_.finest_pixels += pixels;
}

void MapSearch::run_chain(const MatchChain& chain) {
  report_.plan = chain_plan(chain, execution_.options(), execution_.executor().thread_count(),
                            execution_.machine());
  scheduler::run_strips(chain.stages(), report_.plan, execution_.executor(), execution_.scratch());
}

}  // namespace vantage
