#pragma once

#include <string>
#include <vector>

#include "apps/book/figure_inputs.h"
#include "apps/settings/common_options.h"
#include "engine/figures/book_figure.h"

namespace vantage::apps {

/// What `book figure` is asked for.
struct FigureJob {
  std::string command;  ///< as it was typed, for the page
  std::vector<std::string> names;
  bool list = false;
  FigureSettings settings;
  FigureInputs inputs;
  CommonOptions common;
  std::string output;
  bool overwrite = false;
};

/// Lists the figures, or computes those that are named and writes their files and the page. Returns
/// the exit code. Throws UsageError for options that do not go together, and Error.
int run_figures(const FigureJob& job, const Settings& settings);

}  // namespace vantage::apps
