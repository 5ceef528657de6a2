#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/matching/levels/candidate_blocks.h"
#include "engine/matching/levels/level_volume.h"
#include "engine/matching/search/coarse_to_fine/level_plan.h"
#include "engine/matching/windows/coarse_beliefs.h"
#include "kernels/candidates.h"
#include "scheduler/range.h"

namespace vantage {

/// Coarse levels stored while one map is computed: costs of each level, results of two, and the
/// candidate blocks of pruned levels. Working memory, reused without reallocation.
class CoarseLevels {
 public:
  CoarseLevels() = default;
  /// keeps_costs: a later search of parts (SearchedParts) reads those of this one, so that there
  /// are no bands.
  explicit CoarseLevels(bool keeps_costs) : keeps_costs_(keeps_costs) {}

  [[nodiscard]] bool keeps_costs() const { return keeps_costs_; }
  /// Costs of levels with bands have no memory yet.
  void resize(const LevelPlan& plan);
  [[nodiscard]] const LevelPlan& plan() const { return plan_; }

  /// level ≥ 1.
  [[nodiscard]] LevelVolume& costs(int level) {
    return costs_[static_cast<std::size_t>(level) - 1];
  }
  /// Resizes the costs of level 1 of the other image's map.
  LevelVolume& start_other_costs();
  /// Those become the costs of level 1. Sizes must be the same.
  void use_other_costs() { std::swap(costs_.front(), other_costs_); }
  /// Shares its memory with level + 2, whose result is no longer needed.
  [[nodiscard]] LevelVolume& result(int level) {
    return results_[static_cast<std::size_t>(level) % 2];
  }
  /// Resizes the result of `level`.
  LevelVolume& start_result(int level);

  /// Candidate blocks of `level`; null: all candidates. choose_blocks() must come first on pruned
  /// levels.
  [[nodiscard]] const CandidateBlocks* blocks(int level) const {
    return level < plan_.pruned_levels ? &blocks_[static_cast<std::size_t>(level)] : nullptr;
  }
  /// Chooses the blocks of a pruned level from the winners of the next coarser one. `geometry`: of
  /// the image.
  void choose_blocks(int level, const kernels::CandidateGeometry& geometry,
                     CandidateBlocks::SmoothTiles smooth, Execution& execution);
  /// Winners of the level that was computed last.
  [[nodiscard]] const Image<std::int32_t>& coarser_winners() const { return *coarser_winners_; }
  /// Of the image, for volumes: the windows that hold the winners.
  [[nodiscard]] WindowState& windows() { return windows_; }
  /// Image for the winners of `level` ≥ 1, resized to the level. `kept`: an image that outlives the
  /// levels; null: working memory.
  Image<std::int32_t>& start_winners(int level, Image<std::int32_t>* kept);

  [[nodiscard]] std::size_t held_bytes() const;

 private:
  bool keeps_costs_ = false;
  LevelPlan plan_;
  std::vector<LevelVolume> costs_;
  LevelVolume other_costs_;  ///< empty unless shared
  std::array<LevelVolume, 2> results_;
  std::vector<CandidateBlocks> blocks_;             ///< of pruned levels
  std::vector<Image<std::int32_t>> winners_;        ///< of levels from 1 on, unless kept elsewhere
  Image<std::int32_t>* coarser_winners_ = nullptr;  ///< of the previous level
  WindowState windows_;
};

}  // namespace vantage
