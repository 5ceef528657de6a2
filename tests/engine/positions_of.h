#pragma once

namespace vantage {
inline namespace test {

/// Numbers [begin, end).
struct Interval {
  int begin;
  int end;
};

/// The positions of an image or a part of it, row by row, for loops:
/// `for (const auto [x, y] : positions_of(map))`.
class Positions {
 public:
  struct Position {
    int x;
    int y;
  };
  class Iterator {
   public:
    Iterator(Interval columns, int y) : columns_(columns), at_{columns.begin, y} {}
    Position operator*() const { return at_; }
    Iterator& operator++() {
      if (++at_.x >= columns_.end) {
        at_ = {columns_.begin, at_.y + 1};
      }
      return *this;
    }
    bool operator!=(const Iterator& other) const {
      return at_.y != other.at_.y || at_.x != other.at_.x;
    }

   private:
    Interval columns_;
    Position at_;
  };

  Positions(Interval columns, Interval rows) : columns_(columns), rows_(rows) {
    if (columns.begin >= columns.end || rows.begin >= rows.end) {
      rows_.end = rows_.begin;
    }
  }
  [[nodiscard]] Iterator begin() const { return {columns_, rows_.begin}; }
  [[nodiscard]] Iterator end() const { return {columns_, rows_.end}; }

 private:
  Interval columns_;
  Interval rows_;
};

inline Positions positions_of(Interval columns, Interval rows) { return {columns, rows}; }
inline Positions positions_of(int width, int height) { return {{0, width}, {0, height}}; }
template <typename Grid>
Positions positions_of(const Grid& grid) {
  return positions_of(grid.width(), grid.height());
}

}  // namespace test
}  // namespace vantage
