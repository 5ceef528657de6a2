#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/figures/book_figure.h"
#include "engine/image/disparity_range.h"
#include "engine/image/photograph.h"

namespace vantage {

/// Photographs that a figure is about, given or generated.
struct FigureImages {
  std::string description;  ///< what they are, and why these
  Photograph left;
  Photograph right;            ///< of the same size
  DisparityRange disparities;  ///< to search
  /// y_left − y_right to search where the figure searches in two dimensions.
  DisparityRange disparities_y = {-1, 2};
  std::optional<DisparityMap> left_truth = std::nullopt;
  std::optional<Mask> left_visible = std::nullopt;  ///< 255: seen in both; empty: all with truth
  /// More cameras on the baseline, for multiple-baseline stereo.
  std::vector<Photograph> more = {};
  /// Positions of the right and the other cameras relative to the left one.
  std::vector<double> baselines = {1};
  /// The cameras were above each other: rows and columns of the images are exchanged.
  bool is_transposed = false;
  /// The photograph from a position on the baseline, 0 left, 1 right; without a value where there
  /// is none. May be empty.
  std::function<std::optional<Photograph>(double view_x)> view = {};
};

/// The given images, or generated ones that stand in for those of the book.
std::shared_ptr<const FigureImages> images_of(BookImages images, const FigureRun& run);

/// Width of the stand-in, that of the book's images where it is printed.
int default_width(BookImages images);

}  // namespace vantage
