#pragma once

#include <vector>

#include "engine/figures/book_figure.h"

namespace vantage {

// The figures of each file of this folder.
std::vector<BookFigure> comparison_figures();
std::vector<BookFigure> disparity_space_figures();
std::vector<BookFigure> formula_figures();
std::vector<BookFigure> gradient_figures();
std::vector<BookFigure> membrane_figures();
std::vector<BookFigure> pair_map_figures();
std::vector<BookFigure> pattern_figures();
std::vector<BookFigure> response_figures();
std::vector<BookFigure> several_images_figures();
std::vector<BookFigure> view_figures();

}  // namespace vantage
