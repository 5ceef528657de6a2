#include "engine/matching/selection/displacement_selector.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kernels/parabola/parabola.h"

namespace vantage {
namespace {

/// The neighbours of winners in one direction, in rows of three candidates each.
class NeighbourCells {
 public:
  explicit NeighbourCells(bool probabilities) {
    row_.cells = cells_.data();
    row_.geometry = all_partnered(kCount, DisplacementSelector::kMaxColumns);
    row_.geometry.disparity_min = -kWinner;
    row_.first_column = first_partnered_column(kCount);
    row_.probabilities = probabilities;
  }

  /// Adds the next column's winner, whose neighbours are `step` cells away. both_count: whether
  /// both are candidates; otherwise the winner is not refined.
  void add(const float* winner, std::ptrdiff_t step, bool both_count) {
    float* const cells = cells_.data() + row_.columns * row_.geometry.lanes();
    cells[0] = both_count ? winner[-step] : 1;
    cells[1] = both_count ? winner[0] : 1;
    cells[2] = both_count ? winner[step] : 1;
    ++row_.columns;
  }

  /// Offsets of the parabolas' minima from the winners.
  void offsets(float* offset_px) const {
    std::array<std::int32_t, DisplacementSelector::kMaxColumns> winners;
    winners.fill(kWinner);
    kernels::parabola_disparity_row(row_, winners.data(), offset_px);
  }

 private:
  static constexpr int kCount = 3;
  static constexpr int kWinner = 1;

  alignas(
      64) std::array<float, DisplacementSelector::kMaxColumns* kernels::kLaneMultiple> cells_ = {};
  kernels::CellRow row_;
};

}  // namespace

PartneredCandidates DisplacementSelector::candidates(int x, int y) const {
  const int radius = window_radius_;
  const bool is_inside = x >= radius && x < grid_.along_rows.width - radius && y >= radius &&
                         y < grid_.height - radius;
  return is_inside ? PartneredCandidates{grid_.along_rows.with_partner(x, radius),
                                         grid_.rows_with_partner(y, radius)}
                   : PartneredCandidates{};
}

/// Selects among the first `count` cells of some columns, all of which are eligible.
void DisplacementSelector::choose(const float* cells, int count, int columns, std::int32_t* winners,
                                  float* best, float* confidence) const {
  kernels::CellRow row;
  row.cells = cells;
  row.geometry = all_partnered(count, columns);
  row.first_column = first_partnered_column(count);
  row.columns = columns;
  row.probabilities = settings_.cells_are_probabilities;
  select_cells(settings_, row, winners, best, confidence);
}

DisplacementSelector::Values DisplacementSelector::select(const Cells& columns,
                                                          const MapOutputs& outputs,
                                                          float* work) const {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  const std::ptrdiff_t lanes = grid_.columns().lanes();
  Values best;
  Winners winners;
  Values confidence;
  for (int j = 0; j < columns.columns;) {
    const auto at = static_cast<std::size_t>(j);
    const PartneredCandidates own = candidates(columns.first_column + j, columns.y);
    const float* const cells = columns.cells + j * lanes;
    if (own.are_all(grid_)) {
      int end = j + 1;
      while (end < columns.columns &&
             candidates(columns.first_column + end, columns.y).are_all(grid_)) {
        ++end;
      }
      choose(cells, grid_.count(), end - j, &winners[at], &best[at], &confidence[at]);
      j = end;
      continue;
    }
    if (own.empty()) {
      winners[at] = kernels::kNoWinner;
      best[at] = confidence[at] = kUnknown;
    } else {
      own.each_run(grid_, cells, work,
                   [](const float* from, float* to, int count) { std::copy_n(from, count, to); });
      choose(work, own.count(), 1, &winners[at], &best[at], &confidence[at]);
      winners[at] = own.candidate(grid_, winners[at]);
    }
    ++j;
  }
  const auto row = [&](const ImageView<float>& view) {
    return view.row(columns.y) + columns.first_column;
  };
  refine(columns, winners, row(outputs.disparity_px), row(outputs.disparity_y_px));
  if (!outputs.confidence.empty()) {
    std::copy_n(confidence.data(), columns.columns, row(outputs.confidence));
  }
  return best;
}

/// Disparities of the winners, refined by parabolas if requested.
void DisplacementSelector::refine(const Cells& columns, const Winners& winners, float* disparity_px,
                                  float* disparity_y_px) const {
  const int in_row = grid_.along_rows.count;
  const std::ptrdiff_t lanes = grid_.columns().lanes();
  NeighbourCells across(settings_.cells_are_probabilities);
  NeighbourCells down(settings_.cells_are_probabilities);
  for (int j = 0; j < columns.columns; ++j) {
    const int winner = winners[static_cast<std::size_t>(j)];
    const bool exists = winner != kernels::kNoWinner;
    const int column = exists ? winner % in_row : 0;
    const int row = exists ? winner / in_row : 0;
    const PartneredCandidates own = candidates(columns.first_column + j, columns.y);
    const auto is_inner = [exists](int place, kernels::CandidateRange range) {
      return exists && place > range.begin && place + 1 < range.end;
    };
    const float* const cell = columns.cells + j * lanes + (exists ? winner : 0);
    across.add(cell, 1, is_inner(column, own.columns));
    down.add(cell, in_row, is_inner(row, own.rows));
    constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
    disparity_px[j] =
        exists ? static_cast<float>(grid_.along_rows.disparity_min + column) : kUnknown;
    disparity_y_px[j] = exists ? static_cast<float>(grid_.disparity_y_min + row) : kUnknown;
  }
  if (settings_.subpixel == Subpixel::kNone) {
    return;
  }
  const auto move = [&](const NeighbourCells& neighbours, float* component_px) {
    Values offset_px;
    neighbours.offsets(offset_px.data());
    for (int j = 0; j < columns.columns; ++j) {
      component_px[j] += offset_px[static_cast<std::size_t>(j)];
    }
  };
  move(across, disparity_px);
  move(down, disparity_y_px);
}

}  // namespace vantage
