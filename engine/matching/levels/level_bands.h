#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "scheduler/chain_geometry.h"
#include "scheduler/range.h"

namespace vantage {

/// Costs of coarse levels that take more memory are made in bands, unless
/// ExecutionOptions::level_memory_bytes says otherwise.
inline constexpr std::size_t kDefaultLevelBytes = std::size_t{2} << 30;
/// As memory_bytes: no level has bands.
inline constexpr std::size_t kWithoutBands = std::numeric_limits<std::size_t>::max();

/// The finest coarse levels of very large images keep the costs of a band of rows only. They are
/// made again from the images when the level is searched. Results do not depend on it.
struct LevelBands {
  int levels = 0;  ///< levels 1 to this one have bands; 0: none
  int rows = 0;    ///< of level 1, a multiple of 2^levels

  [[nodiscard]] bool has(int level) const { return level >= 1 && level <= levels; }
  /// Rows of a band of `level`.
  [[nodiscard]] int rows_of(int level) const { return std::max(1, rows >> (level - 1)); }
  friend bool operator==(LevelBands, LevelBands) = default;
};

/// `extents`: of the levels, the image's own first. A level takes `cell_bytes` per lane. No bands
/// if all costs take at most `memory_bytes`, else bands of about an eighth of it, of the levels
/// that take more than a quarter. The coarsest level has none.
LevelBands level_bands(const std::vector<scheduler::Extent>& extents, int lanes, int cell_bytes,
                       std::size_t memory_bytes);

/// The rows of its first stage that a chain reads to make `rows` of its last one, of the same
/// extent.
scheduler::Range rows_of_source(scheduler::Chain chain, scheduler::Range rows);

}  // namespace vantage
