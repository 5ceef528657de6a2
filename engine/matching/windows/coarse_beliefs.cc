#include "engine/matching/windows/coarse_beliefs.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <vector>

#include "engine/image/memory_use.h"
#include "kernels/candidates.h"

namespace vantage {
namespace {

using kernels::kLaneMultiple;
using kernels::WindowCells;

constexpr WindowCells kUnknown = ~WindowCells{0};

/// Lanes of the blocks of a column: −1 for blocks that it does not hold.
class BlockLanes {
 public:
  explicit BlockLanes(int blocks) : lanes_(static_cast<std::size_t>(blocks) + 1, -1) {}
  void set(BlockList blocks) {
    std::ranges::fill(lanes_, -1);
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      lanes_[blocks[k]] = static_cast<int>(k) * kLaneMultiple;
    }
  }
  /// The cells of kValid consecutive candidates from `first` on.
  template <int kValid>
  [[nodiscard]] WindowCells fetch(const std::uint8_t* column, int first) const {
    const auto block = static_cast<std::size_t>(first / kLaneMultiple);
    const int place = first % kLaneMultiple;
    const int here = lanes_[block];
    if (here >= 0 &&
        (place + kValid <= kLaneMultiple || lanes_[block + 1] == here + kLaneMultiple)) {
      if constexpr (kValid == 8) {
        WindowCells cells;
        std::memcpy(&cells, column + here + place, sizeof(cells));
        return cells;
      }
      // In registers: reading eight bytes of which six were just written would wait.
      static_assert(kValid == 6 || kValid == 8);
      std::uint32_t first_four;
      std::uint16_t last_two;
      std::memcpy(&first_four, column + here + place, sizeof(first_four));
      std::memcpy(&last_two, column + here + place + sizeof(first_four), sizeof(last_two));
      return kUnknown << 48 | WindowCells{last_two} << 32 | first_four;
    }
    WindowCells cells = kUnknown;
    for (int i = 0; i < kValid; ++i) {
      const int lane = lanes_[block + static_cast<std::size_t>((place + i) / kLaneMultiple)];
      if (lane >= 0) {
        cells &= ~(WindowCells{255} << (8 * i));
        cells |= WindowCells{column[lane + (place + i) % kLaneMultiple]} << (8 * i);
      }
    }
    return cells;
  }

 private:
  std::vector<int> lanes_;  ///< of all blocks, and one that no column holds
};

}  // namespace

LevelBeliefs::LevelBeliefs(const LevelVolume& energies, const CandidateBlocks* blocks,
                           ImageView<const std::int32_t> winners,
                           const kernels::CandidateGeometry& geometry, double nats_per_step)
    : energies_(energies),
      blocks_(blocks),
      winners_(winners),
      disparity_min_(geometry.disparity_min),
      blocks_count_(geometry.lanes() / kLaneMultiple),
      nats_per_step_(nats_per_step) {}

void LevelBeliefs::winners_row(int y, std::int16_t* winners) const {
  const std::int32_t* const row = winners_.row(y);
  std::transform(row, row + winners_.width(), winners,
                 [](std::int32_t winner) { return static_cast<std::int16_t>(winner); });
}

void LevelBeliefs::energies_row(int y, scheduler::Range columns, const std::int16_t* first,
                                int valid, WindowCells* energies) const {
  if (valid == 8) {
    fetch_row<8>(y, columns, first, energies);
  } else {
    fetch_row<6>(y, columns, first, energies);
  }
}

template <int kValid>
void LevelBeliefs::fetch_row(int y, scheduler::Range columns, const std::int16_t* first,
                             WindowCells* energies) const {
  BlockLanes lanes(blocks_count_);
  if (blocks_ == nullptr) {
    std::vector<std::uint16_t> all(static_cast<std::size_t>(blocks_count_));
    std::iota(all.begin(), all.end(), std::uint16_t{0});
    lanes.set(all);
  }
  for (int x = columns.begin; x < columns.end;) {
    int end = columns.end;
    if (blocks_ != nullptr) {
      const CandidateBlocks::Run run = blocks_->run_at(x, y, columns.end);
      lanes.set(run.blocks);
      end = run.columns.end;
    }
    for (; x < end; ++x) {
      if (first[x] >= 0) {
        energies[x] = lanes.fetch<kValid>(energies_.column<std::uint8_t>(x, y), first[x]);
      }
    }
  }
}

std::size_t WindowState::held_bytes() const {
  return vantage::held_bytes(support) + vantage::held_bytes(start) + vantage::held_bytes(winner);
}

void WindowBeliefs::winners_row(int y, std::int16_t* winners) const {
  std::copy_n(state_.winner.row(y), state_.winner.width(), winners);
}

void WindowBeliefs::energies_row(int y, scheduler::Range columns, const std::int16_t* first,
                                 int /*valid*/, WindowCells* energies) const {
  constexpr WindowCells kEveryByte = 0x0101'0101'0101'0101;
  const WindowCells ceiling = kEveryByte * static_cast<WindowCells>(state_.ceiling);
  const WindowCells* const support = state_.support.row(y);
  const std::int16_t* const start = state_.start.row(y);
  for (int x = columns.begin; x < columns.end; ++x) {
    const int lanes = first[x] - start[x];
    if (std::abs(lanes) >= kernels::kWindowCandidates) {
      energies[x] = kUnknown;
      continue;
    }
    const auto moved = [lanes](WindowCells cells) {
      return lanes >= 0 ? cells >> (8 * lanes) : cells << (-8 * lanes);
    };
    // No byte borrows from the next: cells are at most the ceiling.
    energies[x] = (ceiling - moved(support[x])) | ~moved(kUnknown);
  }
}

}  // namespace vantage
