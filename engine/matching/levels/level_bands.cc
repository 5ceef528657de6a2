#include "engine/matching/levels/level_bands.h"

namespace vantage {

LevelBands level_bands(const std::vector<scheduler::Extent>& extents, int lanes, int cell_bytes,
                       std::size_t memory_bytes) {
  const auto row_bytes = [&](std::size_t level) {
    return static_cast<std::size_t>(extents[level].columns) *
           static_cast<std::size_t>(lanes * cell_bytes);
  };
  const auto level_bytes = [&](std::size_t level) {
    return row_bytes(level) * static_cast<std::size_t>(extents[level].rows);
  };
  std::size_t all = 0;
  for (std::size_t level = 1; level < extents.size(); ++level) {
    all += level_bytes(level);
  }
  if (all <= memory_bytes) {
    return {};
  }
  LevelBands bands;
  while (static_cast<std::size_t>(bands.levels) + 2 < extents.size() &&
         level_bytes(static_cast<std::size_t>(bands.levels) + 1) > memory_bytes / 4) {
    ++bands.levels;
  }
  if (bands.levels == 0) {
    return {};
  }
  const std::size_t of_band = memory_bytes / 8;
  const int multiple = 1 << bands.levels;
  const auto rows = static_cast<int>(
      std::min<std::size_t>(of_band / row_bytes(1), static_cast<std::size_t>(extents[1].rows)));
  bands.rows = std::max(1, rows / multiple) * multiple;
  return bands;
}

scheduler::Range rows_of_source(scheduler::Chain chain, scheduler::Range rows) {
  int above = 0;
  int below = 0;
  for (const scheduler::RowReach& reach : scheduler::row_reaches(chain)) {
    above += reach.above;
    below += reach.below;
  }
  const int end = chain.front()->extent().rows;
  return {std::max(0, rows.begin - above), std::min(end, rows.end + below)};
}

}  // namespace vantage
