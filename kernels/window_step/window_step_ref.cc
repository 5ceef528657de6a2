#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "kernels/window_step/window_step.h"

namespace vantage::kernels {
namespace {

using Totals = std::array<std::array<int, kWindowCandidates>, kWindows>;

/// Cells of a neighbour's window, moved to the lanes of a window that begins at `start`.
int support_at(const WindowRow& row, std::size_t window, int x, int candidate) {
  const int lane = candidate - row.start[window][x];
  return lane < 0 || lane >= kWindowCandidates ? 0 : window_cell(row.support[window][x], lane);
}

int weighted_support(const WindowStepRow& row, const WindowRow& of, int x, int column,
                     int candidate, FixedWeight weight) {
  int support = support_at(of, 0, x, candidate);
  if (row.near_second[column] != 0) {
    support = std::max(support, support_at(of, 1, x, candidate));
  }
  return (support * 8 * weight) >> 16;
}

/// T of column x, 0 in windows that do not exist.
Totals totals(const WindowStepRow& row, int x) {
  Totals totals{};
  for (std::size_t q = 0; q < kWindows; ++q) {
    if (q == 1 && (row.near_second[x] == 0 || row.has_second[x] == 0)) {
      continue;
    }
    for (int k = 0; k < kWindowCandidates; ++k) {
      const int candidate = row.centre.start[q][x] + k;
      const auto part = [&](const WindowRow& of, int at, FixedWeight weight) {
        return weighted_support(row, of, at, x, candidate, weight);
      };
      totals[q][static_cast<std::size_t>(k)] =
          kWindowTotalUnits * window_cell(row.evidence[q][x], k) + part(row.centre, x, row.mu) +
          part(row.centre, x - 1, row.beside[x]) + part(row.centre, x + 1, row.beside[x + 1]) +
          part(row.up, x, row.above[x]) + part(row.down, x, row.below[x]);
    }
  }
  return totals;
}

int max_of(const Totals& totals) {
  return std::max(*std::max_element(totals[0].begin(), totals[0].end()),
                  *std::max_element(totals[1].begin(), totals[1].end()));
}

int cell_of(int total, int max, const WindowPrior& prior) {
  return std::max(0, total - max + prior.ceiling);
}

WindowCells packed(const std::array<int, kWindowCandidates>& quarters, WindowCells lanes) {
  WindowCells cells = 0;
  for (int k = 0; k < kWindowCandidates; ++k) {
    const int cell = (quarters[static_cast<std::size_t>(k)] + 2) / kWindowTotalUnits;
    cells |= static_cast<WindowCells>(std::min(cell, 255)) << (8 * k);
  }
  return cells & lanes;
}

}  // namespace

void window_step_row_ref(const WindowStepRow& row,
                         const std::array<WindowCells*, kWindows>& support) {
  for (int x = 0; x < row.columns; ++x) {
    const Totals of_column = totals(row, x);
    const int max = max_of(of_column);
    for (std::size_t q = 0; q < kWindows; ++q) {
      std::array<int, kWindowCandidates> quarters{};
      for (int k = 0; k < kWindowCandidates; ++k) {
        int best = of_column[q][static_cast<std::size_t>(k)];
        for (int offset = 1; offset <= row.prior.radius; ++offset) {
          for (const int other : {k - offset, k + offset}) {
            if (other >= 0 && other < kWindowCandidates) {
              best = std::max(best, of_column[q][static_cast<std::size_t>(other)] -
                                        row.prior.rises[static_cast<std::size_t>(offset - 1)]);
            }
          }
        }
        quarters[static_cast<std::size_t>(k)] = cell_of(best, max, row.prior);
      }
      const bool exists = q == 0 || (row.near_second[x] != 0 && row.has_second[x] != 0);
      support[q][x] = exists ? packed(quarters, row.prior.lanes) : 0;
    }
  }
  for (std::size_t q = 0; q < kWindows; ++q) {
    std::fill_n(support[q] + row.columns, kWindowMargin, WindowCells{0});
  }
}

void window_winners_row_ref(const WindowStepRow& row, const WindowWinners& winners) {
  for (int x = 0; x < row.columns; ++x) {
    const Totals of_column = totals(row, x);
    const int max = max_of(of_column);
    int best = -1;
    winners.window[x] = kNoWindow;
    winners.lane[x] = 0;
    winners.total[x] = winners.total_before[x] = winners.total_after[x] = 0;
    for (std::size_t q = 0; q < kWindows; ++q) {
      if (q == 1 && (row.near_second[x] == 0 || row.has_second[x] == 0)) {
        continue;
      }
      const WindowCells selectable = winners.selectable[q] != nullptr
                                         ? winners.selectable[q][x] & row.prior.lanes
                                         : row.prior.lanes;
      for (int k = 0; k < kWindowCandidates; ++k) {
        const auto& of_window = of_column[q];
        const int total = of_window[static_cast<std::size_t>(k)];
        if (window_cell(selectable, k) == 0 || total <= best) {
          continue;
        }
        best = total;
        winners.window[x] = static_cast<std::uint8_t>(q);
        winners.lane[x] = static_cast<std::uint8_t>(k);
        winners.total[x] = static_cast<std::uint16_t>(total);
        winners.total_before[x] =
            k > 0 ? static_cast<std::uint16_t>(of_window[static_cast<std::size_t>(k - 1)])
                  : std::uint16_t{0};
        winners.total_after[x] =
            k + 1 < kWindowCandidates
                ? static_cast<std::uint16_t>(of_window[static_cast<std::size_t>(k + 1)])
                : std::uint16_t{0};
      }
    }
    if (winners.support != nullptr) {
      std::array<int, kWindowCandidates> quarters{};
      const auto& of_window = of_column[winners.window[x] == 1 ? 1 : 0];
      std::transform(of_window.begin(), of_window.end(), quarters.begin(),
                     [&](int total) { return cell_of(total, max, row.prior); });
      winners.support[x] = packed(quarters, row.prior.lanes);
    }
  }
}

void window_disparity_row_ref(const WindowDisparities& row, int begin, int end,
                              float* disparity_px) {
  const WindowWinners& winners = *row.winners;
  for (int x = begin; x < end; ++x) {
    const std::uint8_t window = winners.window[x];
    if (window == kNoWindow) {
      disparity_px[x] = std::numeric_limits<float>::quiet_NaN();
      continue;
    }
    const int lane = winners.lane[x];
    const auto disparity = static_cast<float>(row.disparity_min + row.start[window][x] + lane);
    const int before = winners.total_before[x];
    const int after = winners.total_after[x];
    const int curvature = 2 * winners.total[x] - before - after;
    const bool moves = row.is_refined && lane > 0 && lane + 1 < row.candidates && curvature > 0;
    disparity_px[x] =
        moves ? disparity + static_cast<float>(after - before) / static_cast<float>(2 * curvature)
              : disparity;
  }
}

}  // namespace vantage::kernels
