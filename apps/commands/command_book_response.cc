#include "apps/book/response_job.h"
#include "apps/commands/commands.h"
#include "apps/inputs/input_limits.h"
#include "apps/settings/command_line.h"
#include "apps/settings/common_options.h"
#include "engine/options/match_settings.h"
#include "engine/options/parameter_settings.h"
#include "engine/options/settings.h"

namespace vantage::apps {
namespace {

void add_response_settings(Settings& settings, ResponseJob& job) {
  settings.start_group("Files");
  settings.positional("left", job.left, "Left image").required = true;
  settings.positional("right", job.right, "Right image of the same size").required = true;
  Setting& output =
      settings.path("output", job.output, "FILE",
                    "Path to the sums: .csv with one row per displacement, or .npy of shape (5, y, "
                    "x): whole image, top left, top right, bottom left and bottom right quadrant");
  output.short_name = 'o';
  output.required = true;

  settings.start_group("Displacements");
  constexpr const char* kAutomatic = "auto";
  Setting& x = settings.add("displacements-x", "MIN:MAX",
                            "Range of x_left - x_right in pixels, both ends included; auto: -16 to "
                            "a quarter of the width");
  x.set = [&job](const SettingValue& value) {
    job.displacements_x = value == kAutomatic
                              ? std::nullopt
                              : std::optional(to_disparity_range(value,
                                                                 "MIN:MAX in whole pixels, such as "
                                                                 "-16:63, or auto"));
  };
  x.get = [&job]() -> SettingValue {
    return job.displacements_x ? to_text(*job.displacements_x) : kAutomatic;
  };
  Setting& y = settings.add("displacements-y", "MIN:MAX",
                            "Range of y_left - y_right in pixels, both ends included");
  y.set = [&job](const SettingValue& value) {
    job.displacements_y = to_disparity_range(value, "MIN:MAX in whole pixels, such as -4:4");
  };
  y.get = [&job] { return to_text(job.displacements_y); };

  settings.start_group("Evidence");
  add_gradient_settings(settings, job.parameters);
  add_common_settings(settings, job.common, Work::kWithoutMatching);
  add_input_limit_settings(settings, job.common.execution);
  settings.set_short_help(
      {"left", "right", "output", "displacements-x", "displacements-y", "threads", "quiet"},
      {"vantage book response left.png right.png -o response.csv",
       "vantage book response left.png right.png -o response.csv --displacements-x 0:63",
       "vantage book response left.png right.png -o response.npy --displacements-y -4:4"});
}

}  // namespace

int command_book_response(const Arguments& arguments) {
  ResponseJob job;
  Settings settings("book response",
                    "Sums the gradient evidence of a pair for a range of displacements, over the "
                    "image and its quadrants, and prints the maxima. 'vantage book figure 5.4 5.5' "
                    "draws them.");
  add_response_settings(settings, job);
  return read_command_line(settings, arguments) ? run_response(job, settings) : kExitDone;
}

}  // namespace vantage::apps
