#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/matching/levels/candidate_blocks.h"
#include "engine/matching/levels/level_volume.h"
#include "engine/matching/match_chain.h"
#include "kernels/candidates.h"
#include "scheduler/range.h"

namespace vantage {

/// What is stored of coarse levels while one map is computed: costs of each, results of two, and
/// which candidates are looked at on levels that do not look at all.
/// Working memory, reused from map to map without allocating.
class CoarseLevels {
 public:
  /// For `extents` of levels, the image's own first, and so many candidates.
  void resize(const MethodParameters& parameters, const std::vector<scheduler::Extent>& extents,
              int candidates);

  /// level ≥ 1.
  [[nodiscard]] LevelVolume& costs(int level) {
    return costs_[static_cast<std::size_t>(level) - 1];
  }
  /// The memory is that of level + 2, whose result nobody needs any more, too.
  [[nodiscard]] LevelVolume& result(int level) {
    return results_[static_cast<std::size_t>(level) % 2];
  }
  /// Gives the result of `level` its size.
  LevelVolume& begin_result(int level);

  /// The candidates of `level`, null: all. Those of pruned levels have to be chosen first.
  [[nodiscard]] const CandidateBlocks* blocks(int level) const {
    return level < pruned_levels() ? &blocks_[static_cast<std::size_t>(level)] : nullptr;
  }
  /// Chooses those of a pruned level from the winners of the next coarser one. `geometry`: the
  /// image's.
  void choose_blocks(int level, const kernels::CandidateGeometry& geometry, Execution& execution);
  /// Whether a finer level chooses its candidates from the winners of `level`.
  [[nodiscard]] bool needs_winners(int level) const {
    return level > 0 && level <= pruned_levels();
  }
  /// Where the winners of `level` ≥ 1 go, of its size.
  Image<std::int32_t>& begin_winners(int level);

  [[nodiscard]] std::size_t held_bytes() const;

 private:
  [[nodiscard]] int pruned_levels() const { return static_cast<int>(blocks_.size()); }

  std::vector<LevelVolume> costs_;
  std::array<LevelVolume, 2> results_;
  std::vector<CandidateBlocks> blocks_;  ///< of pruned levels
  Image<std::int32_t> winners_;          ///< of the level before
};

/// Cells that were aggregated.
struct LevelCells {
  double all_levels = 0;
  double finest_level = 0;
};

/// What CoarseLevels takes for images of `extent` and `candidates` disparities, with a CoarseMap or
/// without; 0 for one level.
std::size_t coarse_level_bytes(const MethodParameters& parameters, scheduler::Extent extent,
                               int candidates, bool has_coarse_map);

/// The map of a coarse level, beside the image's own or in its place.
struct CoarseMap {
  int level = 0;  ///< 1 to the coarsest there is; 0: none is wanted
  /// Of the image's size: each winner for all the pixels that its own covers, in whole disparities,
  /// those without a partner not left out.
  ImageView<float> disparity_px = {};
  /// Nothing finer is made: of the outputs, only the size counts.
  bool is_all = false;
};

/// Computes one map coarse to fine (6.7): costs are reduced level by level, energies −ln p0 being
/// added up over blocks of 2×2 columns for Bayesian diffusion (times level_weight) and averaged for
/// other methods. Then each level is aggregated, the coarsest first, starting from what the coarser
/// one ended with: Bayesian diffusion with its probabilities (or their energies) as the first state
/// and its own likelihoods, the membrane with its energies and the pull of its own costs, all
/// others with the mean of their own costs and its energies. Disparities keep their number and unit
/// on all levels. The finest level's costs come from the images, twice, and are never stored.
/// Iterations and σP differ from level to level (at_level).
///
/// `run` is called with one chain after the other: the first reduces the image's costs, the last
/// selects winners into `outputs`. parameters.levels > 1; geometry and outputs are the image's;
/// input without ChainInput::pair.
///
/// With parameters.candidate_blocks > 0 the finest `pruned_levels` levels, all but the coarsest at
/// most, look at few candidates of each tile only (CandidateBlocks): those near the winners of the
/// next coarser level. Costs are reduced from all candidates all the same.
///
/// `coarse_map`, of Bayesian diffusion only, is the same whether finer levels are made or not.
LevelCells match_coarse_to_fine(const MethodParameters& parameters,
                                const kernels::CandidateGeometry& geometry, const ChainInput& input,
                                const MapOutputs& outputs, CoarseLevels& levels,
                                Execution& execution,
                                const std::function<void(const MatchChain&)>& run,
                                const CoarseMap& coarse_map = {});

}  // namespace vantage
