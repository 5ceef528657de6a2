#pragma once

#include "tests/engine/engine_test.h"
#include "tests/engine/plain_levels.h"

namespace vantage {
inline namespace test {

/// What the oracle chose at one pixel; all NaN where there is no candidate.
struct PlainChoice {
  double disparity = 0;   ///< refined where the parameters say so
  double winner = 0;      ///< whole pixels
  double confidence = 0;  ///< M, max p, the certainty in use, or the winner margin
  double energy = 0;      ///< of the winner: E, or −log p
  double runner_up = 0;   ///< least energy of the other candidates; +∞ for a single one
  double curvature = 0;   ///< of the parabola; NaN where a neighbour is no candidate
};

struct PlainMap {
  int width = 0;
  int height = 0;
  std::vector<PlainChoice> choices;

  [[nodiscard]] const PlainChoice& at(int x, int y) const {
    return choices[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                   static_cast<std::size_t>(x)];
  }
};

/// Cells after aggregation, as energies (−log p for Bayes); NaN where border `valid` has no window.
Volume plain_aggregate(const Photograph& reference, const Photograph& other, Side reference_is,
                       DisparityRange range, const MethodParameters& parameters,
                       StoredCells stored = StoredCells::kCompact);

/// Winner-take-all among the candidates with a partner, smallest disparity of equals, and the
/// parabola of EQUATIONS §3.
PlainMap plain_select(const Volume& energies, const MethodParameters& parameters);

/// The whole method on one grid. Disparities that no pixel of such an image can have are left out
/// of `range`, as the matcher does.
PlainMap plain_match(const Photograph& left, const Photograph& right, Side reference,
                     DisparityRange range, const MethodParameters& parameters,
                     StoredCells stored = StoredCells::kCompact);

/// `range` without what no pixel of an image `width_px` wide can have.
DisparityRange possible_range(DisparityRange range, int width_px);

}  // namespace test
}  // namespace vantage
