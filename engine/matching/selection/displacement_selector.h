#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/matching/costs/displacement_grid.h"
#include "engine/matching/costs/partnered_candidates.h"
#include "engine/matching/selection/stage_cell_selection.h"

namespace vantage {

/// Selects displacements from float cells of all displacements, a few columns at a time. Thread
/// rule: immutable.
class DisplacementSelector {
 public:
  static constexpr int kMaxColumns = 32;
  using Values = std::array<float, kMaxColumns>;

  /// Some columns of row y, grid.columns().lanes() cells each.
  struct Cells {
    const float* cells = nullptr;
    int y = 0;
    int first_column = 0;
    int columns = 0;  ///< at most kMaxColumns
  };

  /// window_radius: only candidates whose windows lie in both images count; 0: all with a partner.
  DisplacementSelector(const DisplacementGrid& grid, const CellSelectionSettings& settings,
                       int window_radius)
      : grid_(grid), settings_(settings), window_radius_(window_radius) {}

  /// Working memory, in floats.
  [[nodiscard]] std::size_t work_floats() const {
    return static_cast<std::size_t>(grid_.columns().lanes());
  }

  /// Writes the requested outputs of the columns. Returns the winners' cells, NaN where there is
  /// none.
  Values select(const Cells& columns, const MapOutputs& outputs, float* work) const;

 private:
  using Winners = std::array<std::int32_t, kMaxColumns>;

  [[nodiscard]] PartneredCandidates candidates(int x, int y) const;
  void choose(const float* cells, int count, int columns, std::int32_t* winners, float* best,
              float* confidence) const;
  void refine(const Cells& columns, const Winners& winners, float* disparity_px,
              float* disparity_y_px) const;

  DisplacementGrid grid_;
  CellSelectionSettings settings_;
  int window_radius_;
};

}  // namespace vantage
