#pragma once

#include "kernels/cell_winner/cell_winner.h"
#include "tests/kernels/kernel_test_utils.h"
#include "tests/kernels/winner_rows.h"

namespace vantage::kernels {

/// What float cells of a row are like.
enum class CellKind {
  kConstant,     ///< all candidates equal
  kZero,         ///< all 0
  kFewLevels,    ///< many ties
  kMixedSigns,   ///< small integers: sums are exact, and often 0
  kEnergies,     ///< all different, ≥ 0
  kProbability,  ///< in [0, 1], some 0, some subnormal, many ties
};
inline constexpr CellKind kEnergyKinds[] = {CellKind::kConstant, CellKind::kZero,
                                            CellKind::kFewLevels, CellKind::kMixedSigns,
                                            CellKind::kEnergies};

inline float random_cell(std::mt19937& random, CellKind kind) {
  switch (kind) {
    case CellKind::kConstant:
      return 7.25F;
    case CellKind::kZero:
      return 0;
    case CellKind::kFewLevels:
      return static_cast<float>(random() % 4) / 4;
    case CellKind::kMixedSigns:
      return static_cast<float>(random_int(random, -3, 3));
    case CellKind::kEnergies:
      return static_cast<float>(random()) / 65536.0F;
    case CellKind::kProbability:
      break;
  }
  const float values[] = {0,      1e-42F, 1e-20F,
                          0.125F, 0.25F,  static_cast<float>(random()) / 4294967296.0F};
  return values[random() % std::size(values)];
}

/// Whether margins of `c` mean something for float cells: no index bits, and the radius is that of
/// windows that must be whole or 0.
inline bool is_cell_case(const WinnerCase& c) {
  return c.index_bits == 0 && (c.whole_windows_only || c.radius == 0);
}

/// Random cells of a row. Lanes that hold no candidate hold the best of all, or no number.
struct FloatCells {
  int lanes;
  UnalignedRow<float> cells;

  FloatCells(std::mt19937& random, const WinnerCase& c, CellKind kind)
      : lanes(c.lanes()),
        cells(static_cast<std::size_t>(c.width) * static_cast<std::size_t>(lanes), random() % 5) {
    const float best = kind == CellKind::kProbability ? 3.0F : -1e30F;
    for (int x = 0; x < c.width; ++x) {
      for (int i = 0; i < lanes; ++i) {
        cells[index(x, i)] = c.counts(x, i)      ? random_cell(random, kind)
                             : random() % 2 == 0 ? best
                                                 : std::numeric_limits<float>::quiet_NaN();
      }
    }
  }
  [[nodiscard]] std::size_t index(int x, int i) const {
    return static_cast<std::size_t>(x) * static_cast<std::size_t>(lanes) +
           static_cast<std::size_t>(i);
  }
  [[nodiscard]] float at(int x, int i) const { return cells[index(x, i)]; }
  /// Columns [begin, end).
  [[nodiscard]] CellRow row(const WinnerCase& c, int begin, int end, bool probabilities) const {
    CellRow row;
    row.cells = cells.data() + index(begin, 0);
    row.geometry = {c.width, c.disparity_min, c.count, c.direction, c.steps_per_px};
    row.first_column = begin;
    row.columns = end - begin;
    row.margin = c.radius;
    row.probabilities = probabilities;
    return row;
  }
};

}  // namespace vantage::kernels
