#include "engine/refinement/surface_fill.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "kernels/surface_vote/surface_vote.h"

namespace vantage {
namespace {

constexpr int kBlockPx = 4;  // pixels of a block have one surface
static_assert(kSurfaceTilePx % kBlockPx == 0);
// Tiles whose surfaces vote, in tiles along both axes: the near ones densely.
constexpr std::array kOffsets = {-6, -4, -2, -1, 0, 1, 2, 4, 6};
static_assert(kOffsets.size() * kOffsets.size() <= kernels::kMaxVoters);
constexpr float kSamePx = 1;
// Shares of the votes that must agree.
constexpr float kAgreementOfHidden = 0.5F;
constexpr float kAgreementOutside = 0.7F;

/// The unmatched pixels of a block.
struct UnmatchedBlock {
  int count = 0;
  float x = 0;  // means
  float y = 0;
  float px = 0;
  std::array<std::int32_t, 3> colour{};
};

class SurfaceFill {
 public:
  SurfaceFill(const Mask& unmatched, const OtherCameraView& other, const FilledMediansWork& medians,
              DisparityRange search, SurfaceFillWork& work, DisparityMap& map_px)
      : unmatched_(unmatched),
        other_(other),
        medians_(medians),
        min_px_(static_cast<float>(search.min)),
        max_px_(static_cast<float>(search.max)),
        surfaces_(work.surfaces),
        seen_px_(work.seen_px),
        map_px_(map_px) {}

  void fill_row_of_tiles(int row) {
    kernels::SurfaceVoters voters;
    for (int top = row * kSurfaceTilePx;
         top < std::min((row + 1) * kSurfaceTilePx, map_px_.height()); top += kBlockPx) {
      float* const seen_px = seen_px_.row(top / kBlockPx);
      copy_seen_row(other_, std::min(top + kBlockPx / 2, map_px_.height() - 1), seen_px);
      const kernels::SeenRow seen{
          .disparity_px = seen_px,
          .width = map_px_.width(),
          .columns_per_px = static_cast<float>(direction_of(other_.side)) * other_.columns_per_px};
      int gathered = -1;  // column of the tile whose voters are gathered
      for (int left = 0; left < map_px_.width(); left += kBlockPx) {
        const UnmatchedBlock block = unmatched_block(left, top);
        if (block.count == 0) {
          continue;
        }
        const int column = left / kSurfaceTilePx;
        if (column != gathered) {
          gather(column, row, voters);
          gathered = column;
        }
        fill(block, left, top, voters, seen);
      }
    }
  }

 private:
  [[nodiscard]] bool has_unmatched(int left, int top) const {
    std::array<std::uint8_t, kBlockPx> marks{};
    const auto columns = static_cast<std::size_t>(std::min(kBlockPx, map_px_.width() - left));
    std::uint32_t any = 0;
    static_assert(sizeof(any) == kBlockPx);
    for (int y = top; y < std::min(top + kBlockPx, map_px_.height()); ++y) {
      std::memcpy(marks.data(), unmatched_.row(y) + left, columns);
      any |= std::bit_cast<std::uint32_t>(marks);
    }
    return any != 0;
  }

  /// Calls visit(x, y) for the unmatched pixels of a block.
  template <typename Visit>
  void for_each_unmatched(int left, int top, const Visit& visit) const {
    for (int y = top; y < std::min(top + kBlockPx, map_px_.height()); ++y) {
      for (int x = left; x < std::min(left + kBlockPx, map_px_.width()); ++x) {
        if (unmatched_.at(x, y) != 0) {
          visit(x, y);
        }
      }
    }
  }

  [[nodiscard]] UnmatchedBlock unmatched_block(int left, int top) const {
    UnmatchedBlock block;
    if (!has_unmatched(left, top)) {
      return block;
    }
    for_each_unmatched(left, top, [&](int x, int y) {
      ++block.count;
      block.x += static_cast<float>(x);
      block.y += static_cast<float>(y);
      block.px += map_px_.at(x, y);
      const std::uint8_t* const pixel = medians_.pixel(x, y);
      for (std::size_t c = 0; c < block.colour.size(); ++c) {
        block.colour[c] += pixel[c];
      }
    });
    const auto count = static_cast<float>(block.count);
    block.x /= count;
    block.y /= count;
    block.px /= count;
    for (std::int32_t& level : block.colour) {
      level = (level + block.count / 2) / block.count;
    }
    return block;
  }

  void gather(int column, int row, kernels::SurfaceVoters& voters) const {
    voters.count = 0;
    for (const int dy : kOffsets) {
      for (const int dx : kOffsets) {
        const int i = column + dx;
        const int j = row + dy;
        if (i < 0 || i >= surfaces_.columns || j < 0 || j >= surfaces_.rows) {
          continue;
        }
        const SurfaceTile& tile = surfaces_.tiles[surfaces_.index(i, j)];
        if (tile.samples == 0) {
          continue;
        }
        const std::size_t voter = voters.count++;
        voters.disparity_px[voter] = tile.disparity_px;
        voters.slope_x[voter] = tile.slope_x;
        voters.slope_y[voter] = tile.slope_y;
        voters.x[voter] = tile_centre(i);
        voters.y[voter] = tile_centre(j);
        voters.weight[voter] = tile.samples;
        for (std::size_t c = 0; c < tile.colour.size(); ++c) {
          voters.colour[c][voter] = tile.colour[c];
        }
      }
    }
  }

  void fill(const UnmatchedBlock& block, int left, int top, const kernels::SurfaceVoters& voters,
            const kernels::SeenRow& seen) {
    const kernels::VotedSurface voted = kernels::vote_on_surface(voters, {.x = block.x,
                                                                          .y = block.y,
                                                                          .colour = block.colour,
                                                                          .seen = seen,
                                                                          .min_px = min_px_,
                                                                          .max_px = max_px_});
    if (!is_believed(voted, block, seen)) {
      return;
    }
    for_each_unmatched(left, top, [&](int x, int y) {
      map_px_.at(x, y) = std::clamp(
          voters.at(voted.voter, static_cast<float>(x), static_cast<float>(y)), min_px_, max_px_);
    });
  }

  static bool is_believed(const kernels::VotedSurface& voted, const UnmatchedBlock& block,
                          const kernels::SeenRow& seen) {
    if (!(voted.agreement > kAgreementOfHidden)) {
      return false;
    }
    const float seen_px = kernels::seen_at(seen, block.x, voted.disparity_px);
    const bool is_hidden = seen_px > voted.disparity_px + kSamePx;
    const bool hides = kernels::seen_at(seen, block.x, block.px) < block.px - kSamePx;
    return is_hidden || hides || (std::isnan(seen_px) && voted.agreement > kAgreementOutside);
  }

  const Mask& unmatched_;
  const OtherCameraView& other_;
  const FilledMediansWork& medians_;
  float min_px_;
  float max_px_;
  const SurfaceTiles& surfaces_;
  Image<float>& seen_px_;
  DisparityMap& map_px_;
};

}  // namespace

void fill_by_surfaces(const Mask& unmatched, const OtherCameraView& other,
                      const FilledMediansWork& medians, DisparityRange search, Execution& execution,
                      SurfaceFillWork& work, DisparityMap& map_px) {
  find_surface_tiles(unmatched, map_px, medians, execution, work.surfaces);
  work.seen_px.resize(map_px.width(), (map_px.height() + kBlockPx - 1) / kBlockPx);
  SurfaceFill fill(unmatched, other, medians, search, work, map_px);
  execution.for_each_row(work.surfaces.rows, [&](int row) { fill.fill_row_of_tiles(row); });
}

}  // namespace vantage
