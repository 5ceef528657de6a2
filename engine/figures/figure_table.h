#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "engine/figures/book_figure.h"

namespace vantage {

/// All figures and tables, in the order of the book.
std::span<const BookFigure> book_figures();

/// The figures that a name means: the key of one, the number of a chapter, or "all". Throws
/// UsageError that lists the keys.
std::vector<const BookFigure*> figures_named(std::string_view name);

}  // namespace vantage
