#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "engine/matching/levels/level_bands.h"
#include "engine/matching/options/match_options.h"
#include "scheduler/range.h"

namespace vantage {

/// What memory a match depends on.
struct MatchSize {
  scheduler::Extent image;
  int channels = 1;
  /// Positions of the other cameras, as in SequenceOptions::baselines; empty: a pair.
  std::span<const double> baselines = {};
  bool along_lines = false;  ///< of photographs that are not rectified: UnrectifiedMatcher
  std::size_t level_bytes = kDefaultLevelBytes;  ///< ExecutionOptions::level_memory_bytes
};

/// About the memory of matching, except strips, photographs and maps: images for the costs, coarse
/// levels.
std::size_t matching_bytes(const ResolvedMatchOptions& options, const MatchSize& size);

/// One line if matching a pair needs more than `machine_bytes` (0: not known), with photographs and
/// maps; empty if it does not.
std::string memory_obstacle(const ResolvedMatchOptions& options, const MatchSize& size,
                            std::size_t machine_bytes);

}  // namespace vantage
