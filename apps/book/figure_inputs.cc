#include "apps/book/figure_inputs.h"

#include <fmt/format.h>

#include "engine/error.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_io.h"
#include "engine/matching/range_estimation.h"
#include "engine/options/match_settings.h"

namespace vantage::apps {

void add_figure_input_settings(Settings& settings, FigureInputs& inputs) {
  settings.start_group("Photographs (instead of generated scenes, for figures of photographs)");
  settings.input_path("left", inputs.left, "FILE", "Left image of a rectified pair");
  settings.input_path("right", inputs.right, "FILE", "Right image of the same size");
  settings.input_path("truth", inputs.truth, "FILE", "True disparities of the left image");
  settings.number(
      "truth-scale", inputs.truth_scale, "S",
      "Divide values of an integer --truth by S; auto: 256 for 16-bit PNG; required for "
      "8-bit files");
  Setting& disparities = settings.add("disparities", "MIN:MAX",
                                      "Disparities to search in these photographs; auto: found");
  disparities.set = [&inputs](const SettingValue& value) {
    inputs.disparities = is_word(value, "auto")
                             ? std::nullopt
                             : std::optional(to_disparity_range(
                                   value, "MIN:MAX in whole pixels, such as 0:63, or auto"));
  };
  disparities.get = [&inputs]() -> SettingValue {
    return inputs.disparities ? SettingValue(to_text(*inputs.disparities)) : SettingValue("auto");
  };
}

void check_figure_inputs(const FigureInputs& inputs, const Settings& settings) {
  if (inputs.left.empty() != inputs.right.empty()) {
    throw UsageError(fmt::format("--{0} is missing, expected --left and --right",
                                 inputs.left.empty() ? "left" : "right"));
  }
  if (inputs.left.empty()) {
    settings.refuse_idle({"truth", "truth-scale", "disparities"}, "without --left and --right");
  }
  require_above_0("truth-scale", inputs.truth_scale);
}

FigureImages read_figure_inputs(const FigureInputs& inputs, Execution& execution) {
  FigureImages images{
      .description = fmt::format("{} and {}, in place of the book's images, which are not public",
                                 inputs.left, inputs.right),
      .left = read_photograph(inputs.left),
      .right = read_photograph(inputs.right),
      .disparities = {}};
  if (!inputs.truth.empty()) {
    images.left_truth = read_disparity(inputs.truth, inputs.truth_scale.value_or(0));
  }
  images.disparities = inputs.disparities
                           ? *inputs.disparities
                           : estimate_disparity_range(images.left, images.right, execution);
  return images;
}

}  // namespace vantage::apps
