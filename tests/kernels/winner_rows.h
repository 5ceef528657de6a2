#pragma once

#include <ostream>

#include "kernels/winner/winner.h"
#include "tests/kernels/kernel_test_utils.h"
#include "tests/test_sample.h"

namespace vantage::kernels {

/// A choice of geometry and settings, and §1 written out for it: nothing here asks the helpers of
/// CandidateGeometry and WinnerRow.
struct WinnerCase {
  int width = 1;
  int disparity_min = 0;
  int count = 1;
  int direction = -1;
  int radius = 0;
  int index_bits = 0;
  bool whole_windows_only = false;
  int steps_per_px = 1;

  /// Window columns of candidate i at column x that lie inside both images.
  [[nodiscard]] int samples(int x, int i) const {
    int inside = 0;
    for (int column = x - radius; column <= x + radius; ++column) {
      inside += in_image(column) && has_partner(column, i) ? 1 : 0;
    }
    return inside;
  }
  /// May candidate i win at column x?
  [[nodiscard]] bool counts(int x, int i) const {
    if (i < 0 || i >= count) {
      return false;
    }
    return whole_windows_only ? samples(x, i) == 2 * radius + 1 : has_partner(x, i);
  }
  /// Have all window columns that lie in the reference image a partner?
  [[nodiscard]] bool is_full(int x, int i) const {
    int inside = 0;
    for (int column = x - radius; column <= x + radius; ++column) {
      inside += in_image(column) ? 1 : 0;
    }
    return samples(x, i) == inside && inside > 0;
  }
  [[nodiscard]] int lanes() const { return (count + 15) / 16 * 16; }
  [[nodiscard]] bool in_image(int column) const { return column >= 0 && column < width; }
  [[nodiscard]] double partner(int x, int i) const {
    const double shift = static_cast<double>(disparity_min + i) / steps_per_px;
    return direction < 0 ? x - shift : x + shift;
  }
  [[nodiscard]] bool has_partner(int x, int i) const {
    return partner(x, i) >= 0 && partner(x, i) <= width - 1;
  }
  [[nodiscard]] WinnerRow row() const {
    WinnerRow row;
    row.geometry = {width, disparity_min, count, direction, steps_per_px};
    row.columns = width;
    row.window_radius = radius;
    row.index_bits = index_bits;
    row.whole_windows_only = whole_windows_only;
    return row;
  }
  friend std::ostream& operator<<(std::ostream& out, const WinnerCase& c) {
    return out << "width " << c.width << ", disparities from " << c.disparity_min << ", " << c.count
               << " of them, " << c.steps_per_px << " per pixel, direction " << c.direction
               << ", radius " << c.radius << ", index bits " << c.index_bits << ", whole windows "
               << c.whole_windows_only;
  }
};

/// Bits that hold the index of any lane.
inline int enough_index_bits(int count) {
  int bits = 1;
  while ((1 << bits) < (count + 15) / 16 * 16) {
    ++bits;
  }
  return bits;
}

/// Geometries of a small world, and of the settings a sample in which each geometry meets each.
inline std::vector<WinnerCase> small_winner_cases() {
  std::vector<WinnerCase> geometries;
  WinnerCase c;
  for (c.width = 1; c.width <= 7; ++c.width) {
    for (c.count = 1; c.count <= 18; c.count += c.count < 5 ? 1 : 4) {
      for (c.disparity_min = -9; c.disparity_min <= 8; ++c.disparity_min) {
        geometries.push_back(c);
      }
    }
  }
  std::vector<WinnerCase> cases;
  for (const test::SampleRow& row :
       test::sampled_rows({static_cast<int>(geometries.size()), 2, 6, 2, 2})) {
    c = geometries[row[0]];
    c.direction = row[1] == 0 ? -1 : 1;
    c.radius = row[2];
    c.whole_windows_only = row[3] == 1;
    c.index_bits = row[4] == 0 ? 0 : enough_index_bits(c.count);
    cases.push_back(c);
  }
  return cases;
}

/// Calls body(case) for a small world, and for draws from a large one (width up to 40, up to 70
/// candidates).
template <typename Body>
void for_each_winner_case(const Body& body) {
  static const std::vector<WinnerCase> small_cases = small_winner_cases();
  for (const WinnerCase& small : small_cases) {
    body(small);
  }
  WinnerCase c;
  std::mt19937 random(31);
  for (int width = 1; width <= 40; ++width) {
    for (int count = 1; count <= 70; ++count) {
      c.width = width;
      c.count = count;
      c.disparity_min = random() % 4 == 0 ? 0 : random_int(random, -width - count, width + 2);
      c.direction = random() % 2 == 0 ? -1 : 1;
      c.steps_per_px = width % 4 == 0 ? 4 : 1 + width % 2;
      c.radius = random_int(random, 0, 5);
      c.whole_windows_only = random() % 2 == 0;
      c.index_bits = random() % 2 == 0 ? 0 : enough_index_bits(count);
      body(c);
    }
  }
}

/// Random sums of a row and the cells that hold them. Cells of lanes that are no candidates would
/// win if anyone looked at them.
struct WinnerCells {
  int lanes;
  std::vector<std::int32_t> sums;
  UnalignedRow<std::int32_t> cells;

  /// Sums in [0, most]: the smaller, the more ties.
  WinnerCells(std::mt19937& random, const WinnerCase& c, std::int32_t max)
      : lanes(c.lanes()),
        sums(static_cast<std::size_t>(c.width) * static_cast<std::size_t>(lanes)),
        cells(sums.size(), random() % 5) {
    for (int x = 0; x < c.width; ++x) {
      for (int i = 0; i < lanes; ++i) {
        const std::size_t cell = index(x, i);
        sums[cell] = static_cast<std::int32_t>(random() % (static_cast<std::uint32_t>(max) + 1U));
        cells[cell] = sums[cell] * (1 << c.index_bits) + (c.index_bits > 0 ? i : 0);
        if (!c.counts(x, i)) {
          cells[cell] = std::numeric_limits<std::int32_t>::min();
        }
      }
    }
  }
  [[nodiscard]] std::size_t index(int x, int i) const {
    return static_cast<std::size_t>(x) * static_cast<std::size_t>(lanes) +
           static_cast<std::size_t>(i);
  }
  [[nodiscard]] std::int64_t sum(int x, int i) const { return sums[index(x, i)]; }
};

/// The largest sum that leaves room for the index: cells stay below 2³¹ − 1.
inline std::int32_t largest_sum(const WinnerCase& c) {
  return (std::numeric_limits<std::int32_t>::max() >> c.index_bits) - 1;
}

}  // namespace vantage::kernels
