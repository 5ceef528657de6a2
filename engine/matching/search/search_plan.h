#pragma once

#include <cstddef>
#include <span>

#include "engine/matching/levels/level_bands.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/search/coarse_to_fine/level_plan.h"
#include "scheduler/range.h"

namespace vantage {

/// What memory a match depends on.
struct MatchSize {
  scheduler::Extent image = {};
  int channels = 1;
  /// Positions of the other cameras, as in SequenceOptions::baselines; empty: a pair.
  std::span<const double> baselines = {};
  bool along_lines = false;  ///< of photographs that are not rectified: UnrectifiedMatcher
  std::size_t level_bytes = kDefaultLevelBytes;  ///< ExecutionOptions::level_memory_bytes

  [[nodiscard]] std::size_t pixels() const {
    return static_cast<std::size_t>(image.columns) * static_cast<std::size_t>(image.rows);
  }
};

/// What a search of images of one size stores, before anything is allocated. Bytes are about those
/// of one call, except strips, photographs and maps.
struct SearchPlan {
  int reductions = 0;  ///< how many times images are halved before all candidates are searched
  LevelPlan levels;    ///< of the images in which all candidates are searched
  std::size_t image_bytes = 0;     ///< images prepared for the costs
  std::size_t map_bytes = 0;       ///< maps beside those that are asked for
  std::size_t edge_bytes = 0;      ///< weights of neighbours
  std::size_t energy_bytes = 0;    ///< of symmetric selection
  std::size_t deferred_bytes = 0;  ///< of a DeferredMatch

  [[nodiscard]] std::size_t bytes() const {
    return image_bytes + map_bytes + edge_bytes + energy_bytes + levels.bytes();
  }
};

/// Of a search of `options` at full size that prepares so many planes of floats per channel.
SearchPlan full_size_plan(const ResolvedMatchOptions& options, const MatchSize& size,
                          std::size_t planes);

}  // namespace vantage
