#pragma once

#include <algorithm>
#include <cstdint>

#include "kernels/candidates.h"

namespace vantage::kernels {

/// One row of summed costs and the meaning of its cells.
///
/// A cell holds the sum of a cost over the samples of a square window that lie inside both images.
/// The energy of a candidate is the *mean* over those samples (§1, border `clip`). Their number
/// follows from the geometry; the number of rows is the same for all cells of a row and cancels.
struct WinnerRow {
  const std::int32_t* cells = nullptr;  ///< first cell of first_column; geometry.lanes() per column
  CandidateGeometry geometry;
  int first_column = 0;
  int columns = 0;
  int window_radius = 0;
  /// Non-zero: cells are sum · 2^index_bits + candidate index. 0: plain sums.
  int index_bits = 0;
  /// Border `valid`: only candidates whose whole window lies in both images count. (The caller
  /// omits rows whose windows exceed the top or bottom.)
  bool whole_windows_only = false;

  /// Candidates of column x that may win.
  [[nodiscard]] CandidateRange candidates(int x) const {
    if (!whole_windows_only) {
      return geometry.with_partner(x);
    }
    if (x < window_radius || x >= geometry.width - window_radius) {
      return {};
    }
    return geometry.with_partner(x, window_radius);
  }
  /// Candidates of column x for which every window column has a partner.
  [[nodiscard]] CandidateRange full_window_candidates(int x) const {
    if (whole_windows_only || !geometry.is_of_one()) {
      return candidates(x);
    }
    return geometry.with_partners(window_begin(x), window_last(x));
  }
  /// Window columns inside the reference image: the count for full_window_candidates().
  [[nodiscard]] int full_window_columns(int x) const {
    return window_last(x) - window_begin(x) + 1;
  }
  /// Window columns that lie inside both images, for a candidate of column x; ≥ 1 for candidates().
  [[nodiscard]] int window_columns(int x, int candidate) const {
    if (!geometry.is_of_one()) {
      return full_window_columns(x);
    }
    const int shift = geometry.steps_per_px * x - geometry.partner(x, candidate);
    return std::min(window_last(x), geometry.width - 1 + geometry.whole_columns(shift)) -
           std::max(window_begin(x), -geometry.whole_columns(-shift)) + 1;
  }
  /// Columns [begin, end) of this row where every candidate has a whole window of partners, so that
  /// cells compare directly.
  [[nodiscard]] CandidateRange plain_columns() const {
    CandidateRange plain = geometry.columns_with_all_partners(window_radius);
    if (whole_windows_only) {
      plain = {std::max(plain.begin, window_radius),
               std::min(plain.end, geometry.width - window_radius)};
    }
    const int begin = std::clamp(plain.begin, first_column, first_column + columns);
    return {begin, std::clamp(plain.end, begin, first_column + columns)};
  }
  [[nodiscard]] std::int32_t sum(std::int32_t cell) const { return cell >> index_bits; }

 private:
  [[nodiscard]] int window_begin(int x) const { return std::max(x - window_radius, 0); }
  [[nodiscard]] int window_last(int x) const {
    return std::min(x + window_radius, geometry.width - 1);
  }
};

inline constexpr std::int32_t kNoWinner = -1;

/// winners[j] = candidate with the minimum energy at column first_column + j, the smallest on ties,
/// or kNoWinner where no candidate counts. Exact: energies are compared as fractions. Cells of
/// candidates must be in [0, 2³¹ − 2]. Identical on every instruction set.
void select_winners_row(const WinnerRow& row, std::int32_t* winners);

/// winners[j] = first candidate of column j whose cell equals minima[j], the minimum over the
/// column's candidates. For cells that compare directly and do not contain their index.
void locate_minima_row(const std::int32_t* cells, const std::int32_t* minima, int lanes,
                       int columns, std::int32_t* winners);

}  // namespace vantage::kernels
