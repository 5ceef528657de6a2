#pragma once

#include <string>
#include <vector>

#include "engine/plot/axis.h"
#include "engine/plot/drawing.h"

namespace vantage {

/// A disc of a chart that a text belongs to. Without a text it is only to be kept clear.
struct LabelledDisc {
  DrawingPoint centre;
  double radius = 1;
  std::string label;
};

struct LabelPlace {
  DrawingPoint corner;  ///< of the text's box: least x and y
  double width = 0;
  double height = 0;
  bool is_far = false;  ///< so far from its disc that a line should lead there
};

/// Where to write the labels, one for each disc, placed in their order: beside the disc, clear of
/// all discs and of the labels placed before, within `area`; farther and farther away until there
/// is room. A label that finds none lies where it covers least.
std::vector<LabelPlace> place_labels(const std::vector<LabelledDisc>& discs, const ChartArea& area);

}  // namespace vantage
