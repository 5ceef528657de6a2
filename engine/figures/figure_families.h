#pragma once

#include <vector>

#include "engine/figures/book_figure.h"

namespace vantage {

// The figures of each file of this folder.
std::vector<BookFigure> comparison_figures();
std::vector<BookFigure> membrane_figures();

}  // namespace vantage
