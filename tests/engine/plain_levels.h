#pragma once

#include "tests/engine/plain_aggregation.h"

namespace vantage {
inline namespace test {

/// What is stored of coarse levels.
enum class StoredCells {
  kExact,
  kCompact,  ///< as the matcher stores them: steps of 1/8 of logarithms, or half floats
};

/// Cells after aggregation on one grid, as energies (−log p for Bayes); NaN where border `valid`
/// has no window. `costs`: energies, −log p0 for Bayes. `coarser`: what the next coarser level
/// ended with, on the grid of `costs`; null: there is none. `grey`: plain_grey() of the level.
Volume plain_level(const Volume& costs, const Volume* coarser, const MethodParameters& parameters,
                   const Volume& grey);

/// The same of all levels, the coarsest first. Without coarse levels: plain_level(). `grey`: of the
/// reference.
Volume plain_coarse_to_fine(const Volume& costs, const MethodParameters& parameters,
                            const Volume& grey, StoredCells stored);

}  // namespace test
}  // namespace vantage
