#include "engine/matching/levels/candidate_blocks.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace vantage {
namespace {

using kernels::kLaneMultiple;
using scheduler::Range;

/// Pixels of disparity on both sides of a coarse winner to include: the finer level finds the best
/// candidate among them.
constexpr int kReachPx = 2;
/// Maximum number of candidates per pixel of disparity.
constexpr int kMaxStepsPerPx = 4;
/// Coarse pixels of a tile along one direction.
constexpr int kCoarsePx = CandidateBlocks::kTilePx / 2;

/// The coarse pixels in a tile or next to it, along one direction.
Range coarse_pixels_around(int tile, int end) {
  return Range{tile * kCoarsePx, (tile + 1) * kCoarsePx}.widened(1, {0, end});
}

/// Range of blocks in which each of `columns` that has candidates with partners has one.
Range blocks_with_partners(const kernels::CandidateGeometry& geometry, Range columns, int blocks) {
  Range allowed{0, blocks};
  for (int x = columns.begin; x < columns.end; ++x) {
    const kernels::CandidateRange inside = geometry.with_partner(x);
    if (!inside.empty()) {
      allowed.begin = std::max(allowed.begin, inside.begin / kLaneMultiple);
      allowed.end = std::min(allowed.end, (inside.end - 1) / kLaneMultiple + 1);
    }
  }
  return allowed;
}

}  // namespace

void CandidateBlocks::resize(scheduler::Extent extent, int candidates, int max, int steps_per_px) {
  extent_ = extent;
  steps_per_px_ = steps_per_px;
  candidates_ = candidates;
  max_ = std::min(max, block_count());
  tile_columns_ = (extent.columns + kTilePx - 1) / kTilePx;
  tile_rows_ = (extent.rows + kTilePx - 1) / kTilePx;
  const std::size_t tiles =
      static_cast<std::size_t>(tile_columns_) * static_cast<std::size_t>(tile_rows_);
  blocks_.resize(tiles * static_cast<std::size_t>(max_));
  counts_.resize(tiles);
  run_ends_.resize(tiles);
  is_as_above_.resize(tiles);
  is_wanted_.resize(tiles);
}

void CandidateBlocks::choose(ImageView<const std::int32_t> winners,
                             const std::optional<kernels::CandidateGeometry>& selected,
                             Execution& execution, SmoothTiles smooth) {
  std::fill(is_wanted_.begin(), is_wanted_.end(), std::uint8_t{1});
  std::vector<Range> allowed(static_cast<std::size_t>(tile_columns_), Range{0, block_count()});
  for (int tile = 0; selected && tile < tile_columns_; ++tile) {
    const Range columns = Range{tile * kTilePx, (tile + 1) * kTilePx};
    allowed[static_cast<std::size_t>(tile)] =
        blocks_with_partners(*selected, columns.widened(0, extent_.all_columns()), block_count());
  }
  execution.for_each_band(tile_rows_, [&](int first_row, int end_row) {
    std::vector<int> votes(static_cast<std::size_t>(block_count()));
    for (int tile_y = first_row; tile_y < end_row; ++tile_y) {
      for (int tile_x = 0; tile_x < tile_columns_; ++tile_x) {
        choose_tile(winners, allowed[static_cast<std::size_t>(tile_x)], tile_x, tile_y, votes);
      }
    }
  });
  if (smooth != SmoothTiles::kIgnored) {
    smooth_ = smooth_tiles(winners, extent_, steps_per_px_, execution);
  }
  if (smooth == SmoothTiles::kLeftOut) {
    leave_out_smooth_tiles();
  }
  execution.for_each_band(tile_rows_, [&](int first_row, int end_row) {
    for (int tile_y = first_row; tile_y < end_row; ++tile_y) {
      compare_tiles(tile_y);
    }
  });
}

void CandidateBlocks::leave_out_smooth_tiles() {
  const auto all_around = [this](int tile_x, int tile_y, int reach_rows, const auto& is_so) {
    const Range rows = Range{tile_y, tile_y + 1}.widened(reach_rows, {0, tile_rows_});
    const Range columns = Range{tile_x, tile_x + 1}.widened(1, {0, tile_columns_});
    for (int y = rows.begin; y < rows.end; ++y) {
      for (int x = columns.begin; x < columns.end; ++x) {
        if (!is_so(x, y)) {
          return false;
        }
      }
    }
    return true;
  };
  for (int tile_y = 0; tile_y < tile_rows_; ++tile_y) {
    for (int tile_x = 0; tile_x < tile_columns_; ++tile_x) {
      // Single tiles are made: shorter runs would cost more than they save.
      const auto is_smooth = [this](int x, int y) { return smooth_.at(x, y); };
      is_wanted_[tile_at(tile_x, tile_y)] = all_around(tile_x, tile_y, 0, is_smooth) ? 0 : 1;
    }
  }
  for (int tile_y = 0; tile_y < tile_rows_; ++tile_y) {
    for (int tile_x = 0; tile_x < tile_columns_; ++tile_x) {
      if (all_around(tile_x, tile_y, 1,
                     [this](int x, int y) { return is_wanted_[tile_at(x, y)] == 0; })) {
        counts_[tile_at(tile_x, tile_y)] = 0;
      }
    }
  }
}

void CandidateBlocks::compare_tiles(int tile_y) {
  for (int tile_x = tile_columns_ - 1; tile_x >= 0; --tile_x) {
    const std::size_t tile = tile_at(tile_x, tile_y);
    const BlockList blocks = of_tile(tile);
    const bool goes_on = tile_x + 1 < tile_columns_ && is_wanted_[tile + 1] == is_wanted_[tile] &&
                         std::ranges::equal(of_tile(tile + 1), blocks);
    run_ends_[tile] = goes_on ? run_ends_[tile + 1] : tile_x + 1;
    const bool is_as_above =
        tile_y > 0 && std::ranges::equal(of_tile(tile_at(tile_x, tile_y - 1)), blocks);
    is_as_above_[tile] = is_as_above ? 1 : 0;
  }
}

bool CandidateBlocks::has_blocks_of(const Run& run, int run_y, int y) const {
  const int tile_y = std::max(run_y, y) / kTilePx;
  if (tile_y == std::min(run_y, y) / kTilePx) {
    return true;
  }
  const std::size_t first = tile_at(run.columns.begin / kTilePx, tile_y);
  const std::size_t last = tile_at((run.columns.end - 1) / kTilePx, tile_y);
  return std::all_of(is_as_above_.begin() + static_cast<std::ptrdiff_t>(first),
                     is_as_above_.begin() + static_cast<std::ptrdiff_t>(last) + 1,
                     [](std::uint8_t is_as_above) { return is_as_above != 0; });
}

void CandidateBlocks::choose_tile(ImageView<const std::int32_t> winners, Range allowed, int tile_x,
                                  int tile_y, std::vector<int>& votes) {
  const std::size_t tile = tile_at(tile_x, tile_y);
  std::uint16_t* const chosen = blocks_.data() + tile * static_cast<std::size_t>(max_);
  const Range columns = coarse_pixels_around(tile_x, winners.width());
  const Range rows = coarse_pixels_around(tile_y, winners.height());
  const auto block_of = [&](int candidate) {
    const int block = std::clamp(candidate, 0, candidates_ - 1) / kLaneMultiple;
    return std::clamp(block, allowed.begin, allowed.end - 1);
  };
  std::int32_t min = candidates_;
  std::int32_t max = 0;
  for (int y = rows.begin; y < rows.end; ++y) {
    const std::int32_t* const of_row = winners.row(y);
    for (int x = columns.begin; x < columns.end; ++x) {
      min = std::min(min, of_row[x]);
      max = std::max(max, of_row[x]);
    }
  }
  const int reach = kReachPx * steps_per_px_;
  const int only = block_of(min - reach);
  if (only == block_of(max + reach)) {  // most tiles: there is nothing to vote on
    chosen[0] = static_cast<std::uint16_t>(only);
    counts_[tile] = 1;
    return;
  }
  std::fill(votes.begin(), votes.end(), 0);
  static_assert(2 * kReachPx * kMaxStepsPerPx <= kLaneMultiple);  // so at most two blocks
  for (int y = rows.begin; y < rows.end; ++y) {
    const std::int32_t* const of_row = winners.row(y);
    for (int x = columns.begin; x < columns.end; ++x) {
      const int first = block_of(of_row[x] - reach);
      const int last = block_of(of_row[x] + reach);
      ++votes[static_cast<std::size_t>(first)];
      votes[static_cast<std::size_t>(last)] += last != first ? 1 : 0;
    }
  }
  int count = 0;
  for (; count < max_; ++count) {
    // The first of the largest.
    const auto best = std::max_element(votes.begin(), votes.end());
    if (*best == 0) {
      break;
    }
    chosen[count] = static_cast<std::uint16_t>(best - votes.begin());
    *best = 0;
  }
  std::sort(chosen, chosen + count);
  counts_[tile] = static_cast<std::uint8_t>(count);
}

int CandidateBlocks::count(BlockList blocks) const {
  if (blocks.empty()) {
    return 0;
  }
  const int lanes = static_cast<int>(blocks.size()) * kLaneMultiple;
  // Only the last block of all can be incomplete.
  const int after = (blocks.back() + 1) * kLaneMultiple - candidates_;
  return lanes - std::max(0, after);
}

double CandidateBlocks::cells() const {
  double cells = 0;
  for (int tile_y = 0; tile_y < tile_rows_; ++tile_y) {
    const int rows = std::min(kTilePx, extent_.rows - tile_y * kTilePx);
    for (int tile_x = 0; tile_x < tile_columns_; ++tile_x) {
      const int columns = std::min(kTilePx, extent_.columns - tile_x * kTilePx);
      cells += static_cast<double>(rows) * columns * count(of_tile(tile_at(tile_x, tile_y)));
    }
  }
  return cells;
}

std::size_t CandidateBlocks::held_bytes() const {
  return blocks_.capacity() * sizeof(std::uint16_t) + counts_.capacity() +
         run_ends_.capacity() * sizeof(int) + is_as_above_.capacity() +
         static_cast<std::size_t>(smooth_.size()) + is_wanted_.capacity();
}

int candidates_in(const CandidateBlocks* blocks, int count) {
  return blocks == nullptr ? count : static_cast<int>(std::lround(blocks->cells_per_pixel()));
}

BlockSegments::BlockSegments(BlockList blocks) {
  for (std::size_t k = 1; k <= blocks.size(); ++k) {
    if (k == blocks.size() || blocks[k] != blocks[k - 1] + 1) {
      ends_[static_cast<std::size_t>(count_++)] = static_cast<int>(k) * kLaneMultiple;
    }
  }
}

template <typename Cell>
void copy_blocks(const Cell* source, BlockList from, BlockList to, Cell absent, Cell* target) {
  std::size_t k = 0;
  for (const std::uint16_t block : to) {
    while (k < from.size() && from[k] < block) {
      ++k;
    }
    if (k < from.size() && from[k] == block) {
      std::copy_n(source + k * kLaneMultiple, kLaneMultiple, target);
    } else {
      std::fill_n(target, kLaneMultiple, absent);
    }
    target += kLaneMultiple;
  }
}
template void copy_blocks(const std::uint8_t*, BlockList, BlockList, std::uint8_t, std::uint8_t*);
template void copy_blocks(const std::int16_t*, BlockList, BlockList, std::int16_t, std::int16_t*);

}  // namespace vantage
