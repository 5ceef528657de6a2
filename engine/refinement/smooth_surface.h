#pragma once

#include "engine/refinement/region_grid.h"

namespace vantage {

/// What a surface between known ends minimises, sums over neighbouring cells that are not absent
/// (EQUATIONS §5.9).
enum class SurfaceEnergy {
  kMembrane,  ///< squared differences: no value beyond the ends, a straight line in one dimension
  kThinPlate  ///< squared second differences, and 1/1000 of the membrane: continues slopes
};

/// Sets the unknown values of `grid` to the surface of minimum energy through the known ones.
/// Regions of up to 4096 unknown cells are solved directly; larger ones on a coarser grid first,
/// whose solution conjugate gradients correct at every finer size, to a few hundredths
/// (membrane) or a tenth (thin plate) of a pixel.
/// At least one cell must be known for each connected part. Thread rule: none; runs on one thread.
void solve_surface(SurfaceEnergy energy, RegionGrid& grid);

}  // namespace vantage
