#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/image/image.h"
#include "engine/plot/drawing.h"

namespace vantage {

/// A surface over an integer grid, shown in colours.
struct HeatMap {
  std::string title;
  std::string x_title;
  std::string y_title;
  int x_first = 0;      ///< x of the first column, in steps of 1
  int y_first = 0;      ///< y of the first row, in steps of 1; y grows downwards, as in images
  Image<float> values;  ///< one channel, at least 1×1; NaN is black
  /// Grid point to mark, if any.
  std::optional<std::pair<int, int>> marked = std::nullopt;
};

/// Heat maps in a grid of `columns` ≥ 1, under one title, each with its own colour scale. Thread
/// rule: pure.
Drawing draw_heat_maps(const std::string& title, const std::vector<HeatMap>& maps, int columns);

}  // namespace vantage
