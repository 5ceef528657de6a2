#include "engine/matching/search/coarse_to_fine/coarse_levels.h"

#include <optional>

namespace vantage {

void CoarseLevels::resize(const LevelPlan& plan) {
  plan_ = plan;
  costs_.resize(static_cast<std::size_t>(plan.coarsest()));
  for (int level = 1; level <= plan.coarsest(); ++level) {
    costs(level).describe(plan.extent(level), plan.lanes(), plan.cell_bytes);
    if (!plan.bands.has(level)) {
      costs(level).hold(plan.extent(level).all_rows());
    }
  }
  winners_.resize(costs_.size());
  blocks_.resize(static_cast<std::size_t>(plan.pruned_levels));
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    blocks_[i].resize(plan.extents[i], plan.candidates, plan.candidate_blocks, plan.steps_per_px);
  }
}

LevelVolume& CoarseLevels::start_other_costs() {
  const LevelVolume& like = costs(1);
  other_costs_.resize(like.extent(), like.lanes(), like.cell_bytes());
  return other_costs_;
}

LevelVolume& CoarseLevels::start_result(int level) {
  LevelVolume& volume = result(level);
  volume.resize(plan_.extent(level), plan_.result_lanes(level), plan_.cell_bytes);
  return volume;
}

void CoarseLevels::choose_blocks(int level, const kernels::CandidateGeometry& geometry,
                                 CandidateBlocks::SmoothTiles smooth, Execution& execution) {
  // Only the finest level selects disparities, which must have partners.
  blocks_[static_cast<std::size_t>(level)].choose(
      std::as_const(*coarser_winners_).view(), level == 0 ? std::optional(geometry) : std::nullopt,
      execution, smooth);
}

Image<std::int32_t>& CoarseLevels::start_winners(int level, Image<std::int32_t>* kept) {
  const scheduler::Extent extent = plan_.extent(level);
  coarser_winners_ = kept != nullptr ? kept : &winners_[static_cast<std::size_t>(level) - 1];
  coarser_winners_->resize(extent.columns, extent.rows);
  return *coarser_winners_;
}

std::size_t CoarseLevels::held_bytes() const {
  std::size_t bytes =
      results_[0].held_bytes() + results_[1].held_bytes() + other_costs_.held_bytes();
  for (const LevelVolume& volume : costs_) {
    bytes += volume.held_bytes();
  }
  for (const CandidateBlocks& blocks : blocks_) {
    bytes += blocks.held_bytes();
  }
  for (const Image<std::int32_t>& winners : winners_) {
    bytes += vantage::held_bytes(winners);
  }
  return bytes + windows_.held_bytes();
}

}  // namespace vantage
