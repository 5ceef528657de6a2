#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scheduler/range.h"

namespace vantage {

/// A yes or no for each tile of an image: squares of side_px pixels, those at the right and lower
/// border cut off. Thread rule: as for a plain array.
class TileMask {
 public:
  static constexpr int kSidePx = 16;

  TileMask() = default;
  /// width, height: of the image.
  TileMask(int width, int height, bool value, int side_px = kSidePx) {
    assign(width, height, value, side_px);
  }

  void assign(int width, int height, bool value, int side_px = kSidePx);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] int columns() const { return columns_; }  ///< of tiles
  [[nodiscard]] int rows() const { return rows_; }        ///< of tiles
  [[nodiscard]] int size() const { return static_cast<int>(tiles_.size()); }
  [[nodiscard]] bool at(int column, int row) const { return tiles_[index(column, row)] != 0; }
  void set(int column, int row, bool value = true) { tiles_[index(column, row)] = value ? 1 : 0; }
  /// Number of tiles that are set.
  [[nodiscard]] int count() const {
    return static_cast<int>(std::count(tiles_.begin(), tiles_.end(), std::uint8_t{1}));
  }
  /// Share of the tiles that are set.
  [[nodiscard]] double share() const { return static_cast<double>(count()) / size(); }

  /// The pixels of a tile.
  [[nodiscard]] scheduler::Region pixels(int column, int row) const {
    return {{column * side_px_, std::min((column + 1) * side_px_, width_)}, row_pixels(row)};
  }
  /// The pixel rows of a row of tiles.
  [[nodiscard]] scheduler::Range row_pixels(int row) const {
    return {row * side_px_, std::min((row + 1) * side_px_, height_)};
  }
  [[nodiscard]] int row_of_pixel(int y) const { return y / side_px_; }

  /// Calls body(columns) for the pixel columns of each maximal run of tiles of a row of tiles that
  /// have `value`.
  template <typename Body>
  void for_each_run(int row, bool value, const Body& body) const {
    for (int column = 0; column < columns_;) {
      int end = column;
      while (end < columns_ && at(end, row) == value) {
        ++end;
      }
      if (end > column) {
        body(scheduler::Range{column * side_px_, std::min(end * side_px_, width_)});
      }
      column = std::max(end, column + 1);
    }
  }

  /// Rectangles of pixels that cover the tiles that are set, and nothing else, each pixel once.
  [[nodiscard]] std::vector<scheduler::Region> regions() const;

  /// The tiles that are not set.
  [[nodiscard]] TileMask inverse() const {
    TileMask result = *this;
    for (std::uint8_t& tile : result.tiles_) {
      tile ^= 1U;
    }
    return result;
  }

  /// The tiles that are set and lie in set tiles of `others`, whose side is a multiple of this
  /// one's.
  [[nodiscard]] TileMask within(const TileMask& others) const {
    TileMask result = *this;
    const int ratio = others.side_px_ / side_px_;
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        result.set(column, row, at(column, row) && others.at(column / ratio, row / ratio));
      }
    }
    return result;
  }

  /// Tiles of side_px of an image whose pixels stand for px_per_column² pixels of this one: those
  /// with pixels in, or within margin_px (of the result's pixels) of, tiles that are set.
  [[nodiscard]] TileMask widened(scheduler::Extent image, int px_per_column, int margin_px,
                                 int side_px) const;

 private:
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }

  int width_ = 0;
  int height_ = 0;
  int side_px_ = kSidePx;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::uint8_t> tiles_;
};

/// Calls body(columns) for the pixel columns of row y in tiles that are set; without tiles, for all
/// `width` columns.
template <typename Body>
void for_each_run_in_row(const TileMask* tiles, int width, int y, const Body& body) {
  if (tiles == nullptr) {
    body(scheduler::Range{0, width});
  } else {
    tiles->for_each_run(tiles->row_of_pixel(y), true, body);
  }
}

}  // namespace vantage
