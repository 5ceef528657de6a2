#pragma once

#include <string>
#include <vector>

#include "engine/image/image.h"
#include "engine/plot/drawing.h"

namespace vantage {

/// A surface over a grid, drawn as a mesh from above and in front: x runs to the right and y
/// towards the viewer.
struct SurfacePlot {
  std::string title;
  std::string x_title;
  std::string y_title;
  std::string z_title;
  int x_first = 0;      ///< x of the first column, in steps of 1
  int y_first = 0;      ///< y of the first row, in steps of 1
  Image<float> values;  ///< one channel, at least 2×2; a mesh with NaN at a corner is left out
  int max_meshes = 100;  ///< per side, ≥ 1; of larger grids every second, third, … value is drawn
};

/// Surfaces in a grid of `columns` ≥ 1, under one title, each with its own scale. Thread rule:
/// pure.
Drawing draw_surface_plots(const std::string& title, const std::vector<SurfacePlot>& plots,
                           int columns);

}  // namespace vantage
