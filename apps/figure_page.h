#pragma once

#include <string>
#include <vector>

#include "engine/figures/book_figure.h"

namespace vantage::apps {

/// A figure as it was made.
struct MadeFigure {
  const BookFigure* figure = nullptr;
  FigureSettings settings;  ///< in force
  FigureContent content;
};

/// An HTML page that needs no other file and no network. `command`: the command line; `machine`:
/// what it ran on.
std::string make_figure_page(const std::vector<MadeFigure>& figures, const std::string& command,
                             const std::string& machine);

/// "size 100, iterations 10, …": what can be chosen, and the parameters that were. Empty: nothing.
std::string describe_settings(const FigureSettings& settings);

}  // namespace vantage::apps
