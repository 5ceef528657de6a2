#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/memory_use.h"
#include "engine/refinement/filled_medians.h"

namespace vantage {

/// Side of a tile, in pixels of the map.
inline constexpr int kSurfaceTilePx = 8;

/// The surface of most matched pixels of a tile.
struct SurfaceTile {
  float samples = 0;       ///< 0: too few matched pixels agree
  float disparity_px = 0;  ///< at the centre
  float slope_x = 0;       ///< pixels of disparity per column
  float slope_y = 0;
  std::array<std::int32_t, 3> colour{};  ///< mean of its samples, 0..255
};

/// Sums over the samples of one tile: places from its centre, disparities from their median.
struct TileMoments {
  float median_px = 0;
  float n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0, d = 0, xd = 0, yd = 0;
};

/// Surfaces of all tiles of a map, row by row, and their working memory.
struct SurfaceTiles {
  int columns = 0;
  int rows = 0;
  std::vector<SurfaceTile> tiles;
  std::vector<TileMoments> moments;

  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
};

inline std::size_t held_bytes(const SurfaceTiles& tiles) {
  return held_bytes(tiles.tiles) + held_bytes(tiles.moments);
}

/// The centre of tile number `tile` along one axis.
constexpr float tile_centre(int tile) {
  return static_cast<float>(tile * kSurfaceTilePx) + 0.5F * (kSurfaceTilePx - 1);
}

/// Fits a plane to the matched pixels (0 in `unmatched`) of every tile and of those beside it that
/// go on (EQUATIONS §5.7). medians: after frame_photograph() of the map's own
/// photograph. Identical for any `execution`.
void find_surface_tiles(const Mask& unmatched, const DisparityMap& map_px,
                        const FilledMediansWork& medians, Execution& execution,
                        SurfaceTiles& surfaces);

}  // namespace vantage
