#pragma once

#include <cstdint>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/tile_mask.h"
#include "scheduler/range.h"

namespace vantage {

/// Side of a tile of a level, in its pixels.
inline constexpr int kLevelTilePx = 8;

/// The tiles of a level of `extent` that are smooth: winners of the next coarser level in and next
/// to the tile differ by at most 2 px from one to the next. Identical for any `execution`.
TileMask smooth_tiles(ImageView<const std::int32_t> coarser_winners, scheduler::Extent extent,
                      int steps_per_px, Execution& execution);

}  // namespace vantage
