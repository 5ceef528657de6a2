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
#include "engine/matching/options/method_parameters.h"
#include "kernels/candidates.h"
#include "scheduler/range.h"

namespace vantage {

/// Numbers of blocks of kLaneMultiple candidates, ascending, at least one: block b holds the
/// candidates [b · kLaneMultiple, (b + 1) · kLaneMultiple). Candidates of the k-th one lie in lanes
/// [k · kLaneMultiple, …) of a column.
using BlockList = std::span<const std::uint16_t>;

/// The candidates that are looked at on a level of matching from coarse to fine: of each tile of
/// 8×8 pixels, aligned to the image, a few blocks. Columns of cells have the same number of lanes
/// everywhere; those behind the blocks of their tile hold anything.
/// Thread rule: as for a plain array.
class CandidateBlocks {
 public:
  static constexpr int kTilePx = 8;
  /// Columns of a run: what stages work on at a time.
  static constexpr int kMostRunColumns = 32;

  /// Columns of a row whose tiles have the same blocks.
  struct Run {
    scheduler::Range columns;
    BlockList blocks;
  };

  /// `most`: blocks of a tile, 1..kMaxCandidateBlocks. Memory is reused.
  void resize(scheduler::Extent extent, int candidates, int most);

  /// Chooses the blocks of all tiles from the winning candidates of the next coarser level. Every
  /// one of its pixels within a tile or beside it votes for the blocks that its winner, or a
  /// candidate up to two from it, lies in; of more than `most` those with the most votes stay, the
  /// smaller one of equals. `selected`: the level's candidates where disparities are going to be
  /// selected; every pixel that has candidates with partners then has one in a block of its tile,
  /// as votes go to the nearest such block. Identical for any `execution`.
  void choose(ImageView<const std::int32_t> winners,
              const std::optional<kernels::CandidateGeometry>& selected, Execution& execution);

  [[nodiscard]] scheduler::Extent extent() const { return extent_; }
  /// Of a column, for the blocks of any tile.
  [[nodiscard]] int lanes() const { return most_ * kernels::kLaneMultiple; }
  [[nodiscard]] BlockList at(int x, int y) const {
    return of_tile(tile_at(x / kTilePx, y / kTilePx));
  }
  /// The run that begins at column x of row y and ends at `end` or before.
  [[nodiscard]] Run run_at(int x, int y, int end) const {
    const std::size_t tile = tile_at(x / kTilePx, y / kTilePx);
    const int run_end = run_ends_[tile] * kTilePx;
    return {{x, std::min({run_end, end, x + kMostRunColumns})}, of_tile(tile)};
  }
  /// Whether row y, another one than that of `run` but at most one away, has its blocks there, too.
  [[nodiscard]] bool has_blocks_of(const Run& run, int run_y, int y) const;
  /// Candidates among the lanes of `blocks`, which come first.
  [[nodiscard]] int count(BlockList blocks) const;
  /// Cells that are looked at, of all pixels.
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
    return {blocks_.data() + tile * static_cast<std::size_t>(most_), counts_[tile]};
  }
  void compare_tiles(int tile_y);
  void choose_tile(ImageView<const std::int32_t> winners, scheduler::Range allowed, int tile_x,
                   int tile_y, std::vector<int>& votes);
  [[nodiscard]] int block_count() const {
    return (candidates_ + kernels::kLaneMultiple - 1) / kernels::kLaneMultiple;
  }

  scheduler::Extent extent_;
  int candidates_ = 0;
  int most_ = 1;
  int tile_columns_ = 0;
  int tile_rows_ = 0;
  std::vector<std::uint16_t> blocks_;  ///< most_ a tile
  std::vector<std::uint8_t> counts_;
  std::vector<int> run_ends_;              ///< the first tile to the right with other blocks
  std::vector<std::uint8_t> is_as_above_;  ///< whether a tile has the blocks of the one above
};

/// The candidate in a lane of the columns of some blocks.
inline int candidate_of(BlockList blocks, int lane) {
  return blocks[static_cast<std::size_t>(lane / kernels::kLaneMultiple)] * kernels::kLaneMultiple +
         lane % kernels::kLaneMultiple;
}

/// Candidates that a pixel has on average: of `blocks`, or, where it is null, all `count` of them.
int candidates_in(const CandidateBlocks* blocks, int count);

/// Where runs of neighbouring candidates end among the lanes of some blocks.
class BlockSegments {
 public:
  explicit BlockSegments(BlockList blocks);
  /// Ascending, the last one the number of lanes. They lie in this object.
  [[nodiscard]] std::span<const int> ends() const& {
    return {ends_.data(), static_cast<std::size_t>(count_)};
  }
  std::span<const int> ends() && = delete;  // a loop over them would outlive the object

 private:
  std::array<int, kMaxCandidateBlocks> ends_;
  int count_ = 0;
};

/// Copies one column of cells from the lanes of blocks `from` to those of blocks `to`; blocks that
/// `from` lacks become `absent`.
template <typename Cell>
void copy_blocks(const Cell* source, BlockList from, BlockList to, Cell absent, Cell* target);

}  // namespace vantage
