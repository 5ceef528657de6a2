#include "engine/sequence/frame_reuse.h"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

/// Every tile is searched once in so many frames.
constexpr int kRefreshFrames = 16;
/// Tiles of squares of so many along one direction are searched together: coarse levels read around
/// them.
constexpr int kRefreshTiles = 4;
/// With a larger share of changed tiles of a map the images moved: the camera does, or there was a
/// cut, and the others are alike by chance.
constexpr double kMaxChangedShare = 0.5;
/// Pixels that changed, from which on a tile has; fewer are noise.
constexpr int kMinChangedPixels = 4;
/// Partners are looked up for every so many pixels in both directions.
constexpr int kPartnerStep = 2;
constexpr int kMinChangedPartners = 2;

bool is_refreshed(int column, int row, int frame) {
  return (column / kRefreshTiles + 7 * (row / kRefreshTiles) + frame) % kRefreshFrames == 0;
}

void copy_tiles(const TileMask& tiles, const Image<std::uint8_t>& image,
                Image<std::uint8_t>& copy) {
  for (int row = 0; row < tiles.rows(); ++row) {
    const scheduler::Range rows = tiles.row_pixels(row);
    tiles.for_each_run(row, true, [&](scheduler::Range columns) {
      for (int y = rows.begin; y < rows.end; ++y) {
        std::copy_n(image.row(y) + columns.begin, columns.size(), copy.row(y) + columns.begin);
      }
    });
  }
}

}  // namespace

void FrameReuse::start_frame(int frame_of_chunk, bool is_first) {
  frame_of_chunk_ = frame_of_chunk;
  if (is_first) {
    forget();
  }
}

/// Whether enough of a tile's pixels, or of the pixels that they were matched with, changed.
bool FrameReuse::has_changed(Side side, const scheduler::Region& pixels) const {
  const Mask& own = still_[index_of(side)];
  const Mask& other = still_[index_of(other_side(side))];
  const DisparityMap& disparity_px = of(side).refinement.refined_px();
  const int map_columns = disparity_px.width() > own.width() ? 2 : 1;
  const float columns_per_px = static_cast<float>(direction_of(side)) / 2;
  int changed = 0;
  int changed_partners = 0;
  const auto [columns, rows] = pixels;
  const auto [begin, end] = columns;
  for (int y = rows.begin; y < rows.end; ++y) {
    const std::uint8_t* const is_still = own.row(y);
    changed += static_cast<int>(std::count(is_still + begin, is_still + end, std::uint8_t{0}));
    if (changed >= kMinChangedPixels) {
      return true;
    }
    if (y % kPartnerStep != 0 || disparity_px.empty()) {
      continue;
    }
    for (int x = begin; x < end; x += kPartnerStep) {
      const float partner = static_cast<float>(x) +
                            columns_per_px * disparity_px.at(map_columns * x, map_columns * y) +
                            0.5F;
      if (partner >= 0 && partner < static_cast<float>(own.width())) {  // false for NaN
        changed_partners += other.at(static_cast<int>(partner), y) == 0 ? 1 : 0;
      }
    }
  }
  return changed_partners >= kMinChangedPartners;
}

bool FrameReuse::choose_tiles(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right,
                              bool is_first, std::array<TileMask, 2>& masks) {
  const std::array<const Image<std::uint8_t>*, 2> images = {&left, &right};
  for (const Side side : {Side::kLeft, Side::kRight}) {
    masks[index_of(side)].assign(left.width(), left.height(), is_first);
    if (is_first) {
      searched_in_[index_of(side)].resize(left.width(), left.height());
    } else {
      still_pixels_.find(searched_in_[index_of(side)], *images[index_of(side)], execution_,
                         still_[index_of(side)]);
    }
  }
  bool has_moved = false;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    TileMask& searched = masks[index_of(side)];
    if (!is_first) {
      execution_.executor().parallel_for(searched.rows(), [&](int row) {
        for (int column = 0; column < searched.columns(); ++column) {
          searched.set(column, row, has_changed(side, searched.pixels(column, row)));
        }
      });
      has_moved = has_moved || searched.share() > kMaxChangedShare;
    }
  }
  for (TileMask& searched : masks) {
    for (int row = 0; row < searched.rows(); ++row) {
      for (int column = 0; column < searched.columns(); ++column) {
        if (has_moved || is_refreshed(column, row, frame_of_chunk_)) {
          searched.set(column, row);
        }
      }
    }
  }
  for (const Side side : {Side::kLeft, Side::kRight}) {
    copy_tiles(masks[index_of(side)], *images[index_of(side)], searched_in_[index_of(side)]);
  }
  return !has_moved;
}

}  // namespace vantage
