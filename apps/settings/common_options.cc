#include "apps/settings/common_options.h"

#include "apps/process/outputs.h"

namespace vantage::apps {

void add_common_settings(Settings& settings, CommonOptions& options, Work work) {
  add_execution_settings(settings, options.execution, work);
  settings.text("isa", options.isa, "NAME",
                "Instruction set of the kernels: best, or a name from 'vantage info'; with "
                "--prior-smoothing sum it changes last bits");
  settings.start_group("Messages", false);
  settings.path("report", options.report, "FILE", "Write a JSON report");
  settings.path("trace", options.trace, "FILE",
                "Write a trace of all threads as Chrome trace events, for Perfetto");
  settings.flag("quiet", options.quiet, "Print errors only");
}

void check_common_files(const CommonOptions& options, FileChecks& files) {
  files.add_output(options.report, "--report", OutputKind::kText);
  files.add_output(options.trace, "--trace", OutputKind::kText);
}

std::uint64_t to_seed(const SettingValue& value) {
  const int number = to_integer(value);
  if (number < 0) {
    reject_value(value, "a whole number of at least 0");
  }
  return static_cast<std::uint64_t>(number);
}

void add_seed_setting(Settings& settings, std::uint64_t& seed) {
  Setting& setting = settings.add("seed", "N", "Random seed; the same seed gives the same images");
  setting.set = [&seed](const SettingValue& value) { seed = to_seed(value); };
  setting.get = [&seed] { return seed; };
}

void add_overwrite_setting(Settings& settings, bool& overwrite) {
  settings.flag("overwrite", overwrite, "Replace files that are in the output folder");
}

}  // namespace vantage::apps
