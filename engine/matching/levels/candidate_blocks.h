#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/tile_mask.h"
#include "engine/matching/levels/smooth_tiles.h"
#include "engine/matching/parameters/method_parameters.h"
#include "kernels/candidates.h"
#include "scheduler/range.h"

namespace vantage {

/// Indices of blocks of kLaneMultiple candidates, ascending, at least one: block b holds candidates
/// [b · kLaneMultiple, (b + 1) · kLaneMultiple). Candidates of the k-th entry lie in lanes [k ·
/// kLaneMultiple, …) of a column.
using BlockList = std::span<const std::uint16_t>;

/// The candidates processed on a level of coarse-to-fine matching: a few blocks for each tile of
/// 8×8 pixels, aligned to the image, or none where nothing is wanted. All columns of cells have the
/// same number of lanes; lanes after the blocks of their tile are undefined. Thread rule: as for a
/// plain array.
class CandidateBlocks {
 public:
  static constexpr int kTilePx = kLevelTilePx;
  /// Maximum columns of a run, which stages process at a time.
  static constexpr int kMaxRunColumns = 32;

  /// Consecutive columns of a row whose tiles have the same blocks.
  struct Run {
    scheduler::Range columns;
    BlockList blocks;
    /// false: only the first state is wanted, which pixels beside a wanted tile read.
    bool is_wanted = true;
  };

  /// What becomes of smooth_tiles().
  enum class SmoothTiles {
    kIgnored,
    kMarked,
    /// Marked and not wanted, on a level of at most one iteration, so most of them are left out.
    /// Those next to a tile that is made keep their blocks: its iteration reads their first states.
    kLeftOut,
  };

  /// `max`: maximum number of blocks per tile, 1..kMaxCandidateBlocks. `steps_per_px`: candidates
  /// per pixel of disparity, at most 4. Memory is reused.
  void resize(scheduler::Extent extent, int candidates, int max, int steps_per_px = 1);

  /// Chooses the blocks of all tiles from the winning candidates of the next coarser level. Each of
  /// its pixels in or next to a tile votes for the blocks that contain its winner or a candidate
  /// within 2 px of it; the `max` blocks with the most votes are kept, ties going to the smaller
  /// one. `selected`: the level's candidates if disparities will be selected on it: votes then go
  /// to the nearest block with partners, so that every pixel that has candidates with partners has
  /// one in a block of its tile. Identical for any `execution`.
  void choose(ImageView<const std::int32_t> winners,
              const std::optional<kernels::CandidateGeometry>& selected, Execution& execution,
              SmoothTiles smooth = SmoothTiles::kIgnored);

  [[nodiscard]] scheduler::Extent extent() const { return extent_; }
  /// Lanes of a column, for any tile.
  [[nodiscard]] int lanes() const { return max_ * kernels::kLaneMultiple; }
  [[nodiscard]] BlockList at(int x, int y) const {
    return of_tile(tile_at(x / kTilePx, y / kTilePx));
  }
  /// The run that starts at column x of row y and ends at or before `end`.
  [[nodiscard]] Run run_at(int x, int y, int end) const {
    const std::size_t tile = tile_at(x / kTilePx, y / kTilePx);
    const int run_end = run_ends_[tile] * kTilePx;
    return {
        {x, std::min({run_end, end, x + kMaxRunColumns})}, of_tile(tile), is_wanted_[tile] != 0};
  }
  /// Not with SmoothTiles::kIgnored.
  [[nodiscard]] const TileMask& smooth() const { return smooth_; }
  /// Whether row y, adjacent to the row run_y of `run`, has the same blocks along the run.
  [[nodiscard]] bool has_blocks_of(const Run& run, int run_y, int y) const;
  /// Number of candidates in the lanes of `blocks`; they come first.
  [[nodiscard]] int count(BlockList blocks) const;
  /// Number of cells processed, over all pixels.
  [[nodiscard]] double cells() const;
  [[nodiscard]] double cells_per_pixel() const {
    return cells() / (static_cast<double>(extent_.columns) * extent_.rows);
  }
  [[nodiscard]] std::size_t held_bytes() const;

 private:
  [[nodiscard]] std::size_t tile_at(int tile_x, int tile_y) const {
    return static_cast<std::size_t>(tile_y) * static_cast<std::size_t>(tile_columns_) +
           static_cast<std::size_t>(tile_x);
  }
  [[nodiscard]] BlockList of_tile(std::size_t tile) const {
    return {blocks_.data() + tile * static_cast<std::size_t>(max_), counts_[tile]};
  }
  void compare_tiles(int tile_y);
  void leave_out_smooth_tiles();
  void choose_tile(ImageView<const std::int32_t> winners, scheduler::Range allowed, int tile_x,
                   int tile_y, std::vector<int>& votes);
  [[nodiscard]] int block_count() const {
    return (candidates_ + kernels::kLaneMultiple - 1) / kernels::kLaneMultiple;
  }

  scheduler::Extent extent_;
  int candidates_ = 0;
  int steps_per_px_ = 1;
  int max_ = 1;
  int tile_columns_ = 0;
  int tile_rows_ = 0;
  std::vector<std::uint16_t> blocks_;  ///< max_ per tile
  std::vector<std::uint8_t> counts_;
  std::vector<int> run_ends_;              ///< first tile to the right with other blocks
  std::vector<std::uint8_t> is_as_above_;  ///< whether a tile has the blocks of the tile above
  TileMask smooth_;
  std::vector<std::uint8_t> is_wanted_;
};

/// The candidate in `lane` of columns with these blocks.
inline int candidate_of(BlockList blocks, int lane) {
  return blocks[static_cast<std::size_t>(lane / kernels::kLaneMultiple)] * kernels::kLaneMultiple +
         lane % kernels::kLaneMultiple;
}

/// Mean number of candidates per pixel: of `blocks` or, if null, all `count`.
int candidates_in(const CandidateBlocks* blocks, int count);

/// Ends of runs of consecutive candidates in the lanes of some blocks.
class BlockSegments {
 public:
  explicit BlockSegments(BlockList blocks);
  /// Ascending; the last one is the number of lanes. Stored in this object.
  [[nodiscard]] std::span<const int> ends() const& {
    return {ends_.data(), static_cast<std::size_t>(count_)};
  }
  std::span<const int> ends() && = delete;  // would dangle in a range-based for

 private:
  std::array<int, kMaxCandidateBlocks> ends_;
  int count_ = 0;
};

/// Copies one column of cells from the lanes of blocks `from` to those of blocks `to`; blocks
/// missing in `from` become `absent`.
template <typename Cell>
void copy_blocks(const Cell* source, BlockList from, BlockList to, Cell absent, Cell* target);

}  // namespace vantage
