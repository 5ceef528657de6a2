#pragma once

#include <array>
#include <cstdint>

#include "kernels/candidate_windows.h"

namespace vantage::kernels {

// Windows of a level from the next coarser one, whose candidates are as far apart, or twice as far.

inline constexpr std::int16_t kNoSecondWinner = INT16_MIN;
/// Coarse candidates by which a neighbour's winner must differ to be another surface's.
inline constexpr int kOtherSurface = 3;

/// A second winner for each column: the smallest winner of the 3×3 columns around it if that is
/// kOtherSurface or more below the column's own, else the largest one if that is as much above it,
/// else kNoSecondWinner. winners: the rows above, at and below, readable for one column on both
/// sides; rows and columns outside the level repeat the nearest ones. Writes up to kWindowMargin
/// columns after the last one. Identical on every instruction set.
void second_winners_row(const std::array<const std::int16_t*, 3>& winners, int columns,
                        std::int16_t* second);
void second_winners_row_ref(const std::array<const std::int16_t*, 3>& winners, int columns,
                            std::int16_t* second);

/// Coarse candidates whose energies the start of a window needs.
constexpr int coarse_candidates(int spacing) {
  return spacing == 1 ? kWindowCandidates : kWindowCandidates / 2 + 2;
}

/// Coarse energies at the place of a window.
struct CoarseEnergies {
  /// Candidates from one coarse candidate to the next, 1 or 2.
  int spacing = 2;
  /// Byte i: the energy of the i-th coarse candidate from the one at or before the window's first
  /// candidate on, 255 where it is not known. coarse_candidates(spacing) bytes are used.
  const WindowCells* energies = nullptr;
  /// With a spacing of 2: 8 if the window begins between that coarse candidate and the next, else
  /// 0.
  const std::uint8_t* offset_bits = nullptr;
  /// Steps of a cell per step of an energy, in units of 1/256.
  std::uint16_t steps = 256;
  std::uint8_t ceiling = 255;           ///< largest cell; energies of 255 are at least that
  WindowCells lanes = ~WindowCells{0};  ///< 255 for the lanes that are candidates
  int columns = 0;
};

/// support[x]: ceiling less energy, at least 0, of the window's candidates. Candidates between two
/// coarse ones have the mean energy, halves rounded up. Writes up to kWindowMargin columns after
/// the last one. Identical on every instruction set.
void window_start_row(const CoarseEnergies& coarse, WindowCells* support);
void window_start_row_ref(const CoarseEnergies& coarse, WindowCells* support);

}  // namespace vantage::kernels
