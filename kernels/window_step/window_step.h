#pragma once

#include <array>
#include <cstdint>

#include "kernels/candidate_windows.h"
#include "kernels/cells/fixed_energy.h"

namespace vantage::kernels {

// Bayesian diffusion with the largest term of the prior (max_product_step) on windows of
// candidates. Energies are turned round: support S = ceiling − ES, so that 0 stands for a candidate
// that a neighbour did not search. One iteration of a column is
//
//   T(d) = E0'(d) + μ S(d) + Σ weight · S_n(d),   S'(d) = max(0, max_k [T(d + k) − rise_k] − max T
//   + ceiling)
//
// with E0' the evidence, and the larger of S where a column's two windows both hold d. All numbers
// are integers: cells in steps, T, rises and ceiling in quarters of a step; results are identical
// on every instruction set.

/// T is in steps of a cell divided by this.
inline constexpr int kWindowTotalUnits = 4;
/// Rises are given for at most this many offsets.
inline constexpr int kMaxWindowPriorRadius = kWindowCandidates - 1;

/// The windows of one row, first and second. Rows whose windows begin at the same candidates should
/// share `start`: their support need not be moved.
struct WindowRow {
  std::array<const WindowCells*, kWindows> support = {};
  std::array<const std::int16_t*, kWindows> start =
      {};  ///< first candidates; differences below 2¹³
};

struct WindowPrior {
  std::array<std::uint16_t, kMaxWindowPriorRadius> rises = {};  ///< for k = 1 … radius
  int radius = 0;
  std::uint16_t ceiling = 0;            ///< at most 255 · kWindowTotalUnits
  WindowCells lanes = ~WindowCells{0};  ///< 255 for the lanes that are candidates
};

/// One row of an iteration. Columns outside the image must have support 0. Columns 2i and 2i + 1,
/// which one coarser column covers, have the same windows.
struct WindowStepRow {
  WindowRow up, centre, down;
  std::array<const WindowCells*, kWindows> evidence = {};  ///< 0 for lanes that are no candidates
  /// 255 for columns with a second window.
  const std::uint8_t* has_second = nullptr;
  /// Not 0 for columns that have a second window, or a neighbour with one; others do not look at
  /// second windows.
  const std::uint8_t* near_second = nullptr;
  FixedWeight mu = 0;
  const FixedWeight* beside = nullptr;  ///< [x]: μ · weight between columns x − 1 and x
  const FixedWeight* above = nullptr;   ///< [x]: for the column above x
  const FixedWeight* below = nullptr;   ///< [x]
  WindowPrior prior;
  int columns = 0;
};

/// S' of both windows; columns after the last one are cleared. Second windows that do not exist
/// become 0.
void window_step_row(const WindowStepRow& row, const std::array<WindowCells*, kWindows>& support);
void window_step_row_ref(const WindowStepRow& row,
                         const std::array<WindowCells*, kWindows>& support);

/// The candidate with the largest T of each column: of the first window unless that of the second
/// is larger, of equal ones in a window the smallest candidate.
struct WindowWinners {
  /// Columns of 255 for candidates that may win; null: all lanes of the prior may.
  std::array<const WindowCells*, kWindows> selectable = {};
  std::uint8_t* window = nullptr;         ///< 0 or 1, kNoWindow if no candidate may win
  std::uint8_t* lane = nullptr;           ///< in that window
  std::uint16_t* total = nullptr;         ///< T of the winner
  std::uint16_t* total_before = nullptr;  ///< T one candidate before it in the window; 0 at its end
  std::uint16_t* total_after = nullptr;   ///< T one candidate after it; 0 at its end
  /// max(0, T − max T + ceiling) in cells, of the window that won; null: not requested.
  WindowCells* support = nullptr;
};
inline constexpr std::uint8_t kNoWindow = 255;

/// Writes up to kWindowMargin columns after the last one.
void window_winners_row(const WindowStepRow& row, const WindowWinners& winners);
void window_winners_row_ref(const WindowStepRow& row, const WindowWinners& winners);

/// disparity_px[x] of winners: disparity_min + start + lane, moved to the vertex of the parabola
/// through T of the winner and its neighbours in the window (EQUATIONS §3.9); not moved at the ends
/// of a window, or where the curvature is not positive. NaN without a winner.
struct WindowDisparities {
  const WindowWinners* winners = nullptr;
  std::array<const std::int16_t*, kWindows> start = {};
  int disparity_min = 0;
  int candidates = kWindowCandidates;  ///< lanes of a window that are candidates
  bool is_refined = true;
  int columns = 0;
};
void window_disparity_row(const WindowDisparities& row, float* disparity_px);
void window_disparity_row_ref(const WindowDisparities& row, int begin, int end,
                              float* disparity_px);

}  // namespace vantage::kernels
