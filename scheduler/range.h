#pragma once

#include <algorithm>

namespace vantage::scheduler {

/// Half-open interval of rows, columns or tasks: begin, begin+1, … end−1.
struct Range {
  int begin = 0;
  int end = 0;

  [[nodiscard]] constexpr int size() const { return end - begin; }
  [[nodiscard]] constexpr bool empty() const { return end <= begin; }
  [[nodiscard]] constexpr bool contains(Range inner) const {
    return begin <= inner.begin && inner.end <= end;
  }
  /// The interval widened by `amount` on both sides and cut to `limits`.
  [[nodiscard]] constexpr Range widened(int amount, Range limits) const {
    return {std::max(begin - amount, limits.begin), std::min(end + amount, limits.end)};
  }
  friend constexpr bool operator==(Range, Range) = default;
};

/// Size of a grid of cells or pixels.
struct Extent {
  int columns = 0;
  int rows = 0;

  [[nodiscard]] constexpr Range all_columns() const { return {0, columns}; }
  [[nodiscard]] constexpr Range all_rows() const { return {0, rows}; }
  friend constexpr bool operator==(Extent, Extent) = default;
};

/// A rectangle of a grid.
struct Region {
  Range columns;
  Range rows;

  [[nodiscard]] constexpr double area() const {
    return static_cast<double>(columns.size()) * rows.size();
  }
  friend constexpr bool operator==(Region, Region) = default;
};

}  // namespace vantage::scheduler
