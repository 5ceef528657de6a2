#include "engine/sequence/past/frame_reuse.h"

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
/// Rows of tiles are looked at in so many parts.
constexpr int kParts = 4;
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

/// Finds tiles whose pixels changed. Stops when so many have that the images moved: false.
bool FrameReuse::find_changed(Side side, const Image<std::uint8_t>& image, TileMask& changed) {
  Mask& still = still_[index_of(side)];
  still.resize(image.width(), image.height());
  const int rows_at_once = (changed.rows() + kParts - 1) / kParts;
  for (int first = 0; first < changed.rows(); first += rows_at_once) {
    const int end = std::min(first + rows_at_once, changed.rows());
    still_pixels_.find_in_rows(searched_in_[index_of(side)], image,
                               {changed.row_pixels(first).begin, changed.row_pixels(end - 1).end},
                               execution_, still);
    execution_.executor().parallel_for(end - first, [&](int of_part) {
      const int row = first + of_part;
      for (int column = 0; column < changed.columns(); ++column) {
        changed.set(column, row, has_changed(side, changed.pixels(column, row)));
      }
    });
    if (changed.share() > kMaxChangedShare) {
      return false;
    }
  }
  return true;
}

/// Adds tiles whose pixels were matched with pixels that changed.
void FrameReuse::add_changed_partners(Side side, TileMask& changed) const {
  if (of(side).refinement.refined_px().empty()) {
    return;
  }
  execution_.executor().parallel_for(changed.rows(), [&](int row) {
    for (int column = 0; column < changed.columns(); ++column) {
      if (!changed.at(column, row)) {
        changed.set(column, row, have_partners_changed(side, changed.pixels(column, row)));
      }
    }
  });
}

bool FrameReuse::has_changed(Side side, const scheduler::Region& pixels) const {
  const auto [begin, end] = pixels.columns;
  int changed = 0;
  for (int y = pixels.rows.begin; y < pixels.rows.end && changed < kMinChangedPixels; ++y) {
    const std::uint8_t* const is_still = still_[index_of(side)].row(y);
    changed += static_cast<int>(std::count(is_still + begin, is_still + end, std::uint8_t{0}));
  }
  return changed >= kMinChangedPixels;
}

bool FrameReuse::have_partners_changed(Side side, const scheduler::Region& pixels) const {
  const Mask& other = still_[index_of(other_side(side))];
  const auto width = static_cast<float>(other.width());
  const DisparityMap& disparity_px = of(side).refinement.refined_px();
  const int map_columns = disparity_px.width() > other.width() ? 2 : 1;
  const float columns_per_px = static_cast<float>(direction_of(side)) / 2;
  int changed = 0;
  // Tiles begin at even rows.
  for (int y = pixels.rows.begin; y < pixels.rows.end && changed < kMinChangedPartners;
       y += kPartnerStep) {
    const std::uint8_t* const is_still = other.row(y);
    const float* const of_row = disparity_px.row(map_columns * y);
    for (int x = pixels.columns.begin; x < pixels.columns.end; x += kPartnerStep) {
      const float partner = static_cast<float>(x) + columns_per_px * of_row[map_columns * x] + 0.5F;
      if (partner >= 0 && partner < width) {  // false for NaN
        changed += is_still[static_cast<int>(partner)] == 0 ? 1 : 0;
      }
    }
  }
  return changed >= kMinChangedPartners;
}

bool FrameReuse::choose_tiles(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right,
                              bool is_first, std::array<TileMask, 2>& masks) {
  const std::array<const Image<std::uint8_t>*, 2> images = {&left, &right};
  for (const Side side : {Side::kLeft, Side::kRight}) {
    masks[index_of(side)].assign(left.width(), left.height(), is_first);
    if (is_first) {
      searched_in_[index_of(side)].resize(left.width(), left.height());
    }
  }
  bool has_moved = false;
  if (!is_first) {
    has_moved =
        !find_changed(Side::kLeft, left, masks[0]) || !find_changed(Side::kRight, right, masks[1]);
    for (const Side side : {Side::kLeft, Side::kRight}) {
      if (!has_moved) {
        add_changed_partners(side, masks[index_of(side)]);
        has_moved = masks[index_of(side)].share() > kMaxChangedShare;
      }
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
