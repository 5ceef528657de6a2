#pragma once

#include <optional>
#include <string>

#include "apps/process/outputs.h"
#include "engine/execution.h"
#include "engine/figures/figure_images.h"
#include "engine/options/settings.h"

namespace vantage::apps {

/// Photographs for figures, in place of generated scenes: two files, or the folder of a public
/// scene.
struct FigureInputs {
  std::string left;
  std::string right;
  std::string truth;  ///< of the left image; may be empty
  std::optional<double> truth_scale;
  std::string data;
  std::optional<DisparityRange> disparities;  ///< empty: found

  [[nodiscard]] bool given() const { return !data.empty() || !left.empty() || !right.empty(); }
};

void add_figure_input_settings(Settings& settings, FigureInputs& inputs);
/// Throws UsageError for options that do not go together.
void check_figure_inputs(const FigureInputs& inputs, const Settings& settings);

/// Reads the images. A folder is recognised by the names of its files: as Middlebury publishes the
/// scenes of 2001 (also tsukuba), 2003, 2005/2006 and 2014/2021; their other photographs serve for
/// multiple baselines and as true views. Throws Error.
FigureImages read_figure_inputs(const FigureInputs& inputs, Execution& execution);

}  // namespace vantage::apps
