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

/// "size 100, iterations 10, …": what the figure reads of its settings in force. Empty: nothing.
std::string describe_settings(const BookFigure& figure, const FigureSettings& in_force);

}  // namespace vantage::apps
