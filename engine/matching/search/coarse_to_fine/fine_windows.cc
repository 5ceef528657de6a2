#include "engine/matching/search/coarse_to_fine/fine_windows.h"

#include <algorithm>
#include <vector>

#include "engine/image/memory_use.h"
#include "engine/matching/windows/window_level.h"

namespace vantage {
namespace {

WindowLevelInput level_input(const MethodParameters& of_level, int level,
                             const kernels::CandidateGeometry& geometry, const ChainInput& input,
                             const CoarseBeliefs& coarse) {
  return {.parameters = of_level,
          .side = 1 << level,
          .spacing = 1,  // all levels have the image's candidates
          .geometry = geometry,
          .reference = *input.reference,
          .partner = *input.partners.front().image,
          .edges = input.edges.empty() ? nullptr : &input.edges[static_cast<std::size_t>(level)],
          .coarse = coarse,
          .prior_px = input.prior_px,
          .prior_weight = input.prior_weight};
}

}  // namespace

std::size_t FineWindowsWork::held_bytes() const {
  return state.held_bytes() + finest.held_bytes() + vantage::held_bytes(coarse_px) +
         vantage::held_bytes(winners);
}

void FineWindows::search_level_1(const CoarseBeliefs& coarse, scheduler::Extent extent,
                                 const std::vector<scheduler::Region>* regions,
                                 Image<std::int32_t>& winners) {
  const MethodParameters of_level = at_level(parameters_, 1);
  work_.coarse_px.resize(extent.columns, extent.rows);
  search_windows(
      level_input(of_level, 1, geometry_, input_, coarse), parameters_.subpixel,
      {.disparity_px = work_.coarse_px.view(), .state = &work_.state, .regions = regions},
      execution_);
  winners.resize(extent.columns, extent.rows);
  execution_.for_each_band(extent.rows, [&](int first_row, int end_row) {
    for (int y = first_row; y < end_row; ++y) {
      std::copy_n(work_.state.winner.row(y), extent.columns, winners.row(y));
    }
  });
}

void FineWindows::search_level_0(const CoarseBeliefs* coarse, const MapOutputs& outputs,
                                 const TileMask* tiles, WindowState* state) {
  const MethodParameters of_level = at_level(parameters_, 0);
  const WindowBeliefs of_level_1(work_.state);
  std::vector<scheduler::Region> regions;
  if (tiles != nullptr) {
    regions = tiles->regions();
  }
  search_windows(
      level_input(of_level, 0, geometry_, input_, coarse != nullptr ? *coarse : of_level_1),
      parameters_.subpixel,
      {.disparity_px = outputs.disparity_px,
       .confidence = outputs.confidence,
       .state = state,
       .regions = tiles != nullptr ? &regions : nullptr},
      execution_);
}

}  // namespace vantage
