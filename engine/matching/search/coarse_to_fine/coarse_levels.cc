#include "engine/matching/search/coarse_to_fine/coarse_levels.h"

#include <algorithm>
#include <optional>

#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/matching/chain/match_chain.h"
#include "engine/matching/levels/level_extents.h"

namespace vantage {

int window_level_count(const MethodParameters& parameters, std::size_t levels) {
  return std::min(parameters.window_levels, static_cast<int>(levels) - 1);
}
int pruned_level_count(const MethodParameters& parameters, std::size_t levels) {
  const int pruned = std::min(parameters.pruned_levels, static_cast<int>(levels) - 1);
  const bool has_blocks =
      parameters.candidate_blocks > 0 && pruned > window_level_count(parameters, levels);
  return has_blocks ? pruned : 0;
}

int level_cell_bytes(const MethodParameters& parameters) {
  return has_likelihoods(parameters) ? 1 : 2;
}

void CoarseLevels::resize(const MethodParameters& parameters,
                          const std::vector<scheduler::Extent>& extents, int candidates,
                          LevelBands bands) {
  const int lanes = kernels::CandidateGeometry{.count = candidates}.lanes();
  bands_ = bands;
  costs_.resize(extents.size() - 1);
  for (std::size_t i = 0; i < costs_.size(); ++i) {
    costs_[i].describe(extents[i + 1], lanes, level_cell_bytes(parameters));
    if (!bands.has(static_cast<int>(i) + 1)) {
      costs_[i].hold(extents[i + 1].all_rows());
    }
  }
  winners_.resize(costs_.size());
  window_levels_ = window_level_count(parameters, extents.size());
  blocks_.resize(static_cast<std::size_t>(pruned_level_count(parameters, extents.size())));
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    blocks_[i].resize(extents[i], candidates, parameters.candidate_blocks,
                      steps_per_px(parameters));
  }
}

LevelVolume& CoarseLevels::start_other_costs() {
  const LevelVolume& like = costs(1);
  other_costs_.resize(like.extent(), like.lanes(), like.cell_bytes());
  return other_costs_;
}

LevelVolume& CoarseLevels::start_result(int level) {
  const LevelVolume& like = costs(level);
  LevelVolume& volume = result(level);
  const CandidateBlocks* const of_level = blocks(level);
  volume.resize(like.extent(), of_level != nullptr ? of_level->lanes() : like.lanes(),
                like.cell_bytes());
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
  const scheduler::Extent extent = costs(level).extent();
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

std::size_t coarse_level_bytes(const MethodParameters& parameters, scheduler::Extent extent,
                               int candidates, std::size_t memory_bytes) {
  const auto extents = level_extents(extent, parameters.levels);
  const int lanes = kernels::CandidateGeometry{.count = candidates}.lanes();
  const int windows = window_level_count(parameters, extents.size());
  const int pruned = pruned_level_count(parameters, extents.size());
  const auto first_result = static_cast<std::size_t>(std::max(1, windows));
  const LevelBands bands = level_bands(extents, lanes, level_cell_bytes(parameters), memory_bytes);
  const auto bytes_of = [&](std::size_t level, int rows, int of_lanes) {
    return static_cast<std::size_t>(extents[level].columns) * static_cast<std::size_t>(rows) *
           static_cast<std::size_t>(of_lanes * level_cell_bytes(parameters));
  };
  std::size_t bytes = 0;
  std::array<std::size_t, 2> results = {0, 0};  // levels share the memory of two
  for (std::size_t level = 1; level < extents.size(); ++level) {
    // A band, the rows around it that its iterations read, and those of the next coarser level.
    const int number = static_cast<int>(level);
    const int around = 2 * (1 + parameters.iterations) << std::max(0, bands.levels - number);
    const int rows = bands.has(number)
                         ? std::min(extents[level].rows, bands.rows_of(number) + around)
                         : extents[level].rows;
    const bool is_shared = level == 1 && can_share_costs(parameters, extent, candidates);
    bytes += (is_shared ? 2 : 1) * bytes_of(level, rows, lanes);
    if (level >= first_result) {
      const int of_result = number < pruned
                                ? std::min(lanes, parameters.candidate_blocks *
                                                      static_cast<int>(kernels::kLaneMultiple))
                                : lanes;
      results[level % 2] =
          std::max(results[level % 2], bytes_of(level, extents[level].rows, of_result));
    }
  }
  bytes += results[0] + results[1];
  if (extents.size() > 1 && (windows > 0 || pruned > 0)) {
    // Winners of level 1; with two levels of windows also its state.
    constexpr std::size_t kState =
        sizeof(kernels::WindowCells) + 2 * sizeof(std::int16_t) + sizeof(float);
    bytes += static_cast<std::size_t>(extents[1].columns) *
             static_cast<std::size_t>(extents[1].rows) *
             (sizeof(std::int32_t) + (windows > 1 ? kState : 0));
  }
  return bytes;
}

}  // namespace vantage
