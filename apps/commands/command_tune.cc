#include <fmt/format.h>

#include <optional>
#include <string>

#include "apps/commands/commands.h"
#include "apps/inputs/input_limits.h"
#include "apps/reports/tune_job.h"
#include "apps/settings/command_line.h"
#include "engine/options/match_settings.h"
#include "engine/options/settings.h"

namespace vantage::apps {
namespace {

void add_tune_settings(Settings& settings, TuneJob& job) {
  settings.start_group("Tuning");
  Setting& size = settings.add("size", "WxH", "Width and height of the images, such as 1280x720");
  size.set = [&job](const SettingValue& value) {
    job.images =
        from_parts(value, 'x', 2, "WxH in whole pixels, such as 1280x720", [](const auto& sides) {
          return std::optional(TunedImages{to_integer(sides[0]), to_integer(sides[1])});
        });
  };
  size.get = [&job]() -> SettingValue {
    return job.images
               ? SettingValue(fmt::format("{}x{}", job.images->width_px, job.images->height_px))
               : SettingValue();
  };
  settings.choice<bool>(
      "images", job.grey, {{"colour", false}, {"grey", true}},
      "Pixel format of the images: grey is 8 bits with one channel, colour is anything else");
  settings.choice<TunedCommands>("for", job.uses,
                                 {{"both", TunedCommands::kBoth},
                                  {"match", TunedCommands::kMatch},
                                  {"run", TunedCommands::kRun}},
                                 "Commands to tune");
  settings.number("budget", job.budget_seconds, "SECONDS", "Time limit of the search");
  settings
      .path("output", job.output, "FILE",
            "Tuning file to write; default: vantage/tuning.json in $XDG_CONFIG_HOME or ~/.config, "
            "where match and run look for it")
      .short_name = 'o';
  settings.flag("dry-run", job.dry_run, "Print what would be tuned, and stop");
  settings.flag("list", job.list, "List the entries of the tuning file");
  add_match_settings(settings, job.match);
  add_common_settings(settings, job.common);
  add_input_limit_settings(settings, job.common.execution);
  settings.set_short_help(
      {"size", "images", "for", "budget", "output", "dry-run", "list", "disparities", "preset",
       "threads", "quiet"},
      {"vantage tune --size 1280x720 --disparities 0:127",
       "vantage tune --size 1280x720 --disparities 0:127 --preset realtime --for run --budget 300",
       "vantage tune --list"});
}

}  // namespace

int command_tune(const Arguments& arguments) {
  TuneJob job;
  Settings settings("tune",
                    "Finds the fastest number of threads, strips, bands, passes and frames in "
                    "flight on this machine, for match and run.");
  add_tune_settings(settings, job);
  return read_command_line(settings, arguments) ? run_tune(job, settings) : kExitDone;
}

}  // namespace vantage::apps
