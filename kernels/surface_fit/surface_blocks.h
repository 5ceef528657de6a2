#pragma once

#include <algorithm>
#include <cstdint>

#include "kernels/surface_fit/surface_fit.h"

namespace vantage::kernels {

/// One row of blocks of 2×2 pixels: two rows of a disparity map and of its mask.
struct SurfaceBlockRow {
  /// `width` values each. The lower row of the last blocks of a map of odd height does not exist:
  /// null in both.
  float* upper_px = nullptr;
  float* lower_px = nullptr;
  const std::uint8_t* upper_unmatched = nullptr;  ///< ≠ 0: unmatched
  const std::uint8_t* lower_unmatched = nullptr;
  int width = 0;  ///< pixels; the last block of an odd width has one column

  /// `blocks` blocks of the row, or fewer at its end, from block number `block` on.
  [[nodiscard]] SurfaceBlockRow from_block(int block, int blocks) const {
    const int x = 2 * block;
    const auto from = [x](auto* values) { return values != nullptr ? values + x : nullptr; };
    return {from(upper_px), from(lower_px), from(upper_unmatched), from(lower_unmatched),
            std::min(2 * blocks, width - x)};
  }
};

/// Number of blocks of a row or column of pixels.
constexpr int surface_blocks(int pixels) { return (pixels + 1) / 2; }

/// In place of disparities without a match, while blocks are made.
constexpr float kNoBlockPx = 1e9F;
/// A block's pixels belong to one surface if they are less than this above the smallest one.
constexpr float kSurfaceBlockRangePx = 1.5F;

/// Disparities of blocks: the mean of the block's matched pixels that are less than
/// kSurfaceBlockRangePx above the smallest one, so that a block has the disparity of one surface,
/// as surface_sample_row() stores it; kNoSurface without a matched pixel. Writes
/// surface_blocks(width) values.
void surface_block_row(const SurfaceBlockRow& row, const SurfaceFormat& format,
                       std::int16_t* blocks);

/// Margin of blocks that fit_surface_block_row() reads around a map of blocks.
constexpr int surface_block_margin(int radius_px) { return radius_px / 2 + 1; }

/// The lattice of blocks for fits within radius_px. Its corners are up to 2 px further away than
/// radius_px, because samples weigh less towards the corners.
SurfaceLattice surface_block_lattice(int radius_px);

/// Like fit_surface_row(), but with one plane for each block of 2×2 pixels, fitted to the
/// disparities of blocks. Each matched pixel takes the plane's value at its own position, unless
/// that is kMaxSurfaceMovePx or more away. `blocks`: the row's blocks and what surrounds them as
/// fit_surface_row() needs it, with a window of surface_block_margin(radius_px) blocks;
/// `blocks.radius_px`: radius_px in pixels; `blocks.width` is not used. Identical on every
/// instruction set.
void fit_surface_block_row(const SurfaceRow& blocks, const SurfaceBlockRow& row);

/// Scalar references.
void surface_block_row_ref(const SurfaceBlockRow& row, const SurfaceFormat& format,
                           std::int16_t* blocks);
void fit_surface_block_row_ref(const SurfaceRow& blocks, const SurfaceBlockRow& row);

/// How much a plane rises over a quarter of a block, from the centre of a block to those of its
/// pixels: factors of its slopes per step.
struct SurfaceQuarterBlock {
  float along = 0;   ///< of slope_u per column and of slope_v per row
  float across = 0;  ///< of −slope_v per column and of slope_u per row
};
inline SurfaceQuarterBlock surface_quarter_block(const SurfaceLattice& lattice) {
  // The inverse of the lattice's steps: a rotation divided by the squared length of a step.
  const auto x = static_cast<float>(lattice.step_x);
  const auto y = static_cast<float>(lattice.step_y);
  const float scale = 0.25F / (x * x + y * y);
  return {x * scale, y * scale};
}

}  // namespace vantage::kernels
