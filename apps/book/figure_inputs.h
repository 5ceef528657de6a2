#pragma once

#include <optional>
#include <string>

#include "apps/process/outputs.h"
#include "engine/execution.h"
#include "engine/figures/figure_images.h"
#include "engine/options/settings.h"

namespace vantage::apps {

/// Photographs for figures, in place of generated scenes.
struct FigureInputs {
  std::string left;
  std::string right;
  std::string truth;  ///< of the left image; may be empty
  std::optional<double> truth_scale;
  std::optional<DisparityRange> disparities;  ///< empty: found

  [[nodiscard]] bool given() const { return !left.empty() || !right.empty(); }
};

void add_figure_input_settings(Settings& settings, FigureInputs& inputs);
/// Throws UsageError for options that do not go together.
void check_figure_inputs(const FigureInputs& inputs, const Settings& settings);

/// Reads the images. Throws Error.
FigureImages read_figure_inputs(const FigureInputs& inputs, Execution& execution);

}  // namespace vantage::apps
