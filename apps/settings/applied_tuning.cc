#include "apps/settings/applied_tuning.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>
#include <variant>

#include "apps/process/tell.h"
#include "apps/reports/tuning_report.h"
#include "scheduler/machine.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

bool is_8_bit_grey(const Photograph& photograph) {
  return std::holds_alternative<Image<std::uint8_t>>(photograph.pixels) &&
         photograph.channels() == 1;
}

/// The tuned settings that the user has not given.
TunedSettings left_open(TunedSettings settings, const TuningSituation& situation) {
  const ExecutionOptions& given = situation.execution;
  const auto drop_if = [](bool is_given, std::optional<int>& field) {
    if (is_given) {
      field.reset();
    }
  };
  drop_if(given.threads.has_value(), settings.threads);
  drop_if(given.strip_width_px.has_value(), settings.strip_width_px);
  drop_if(given.band_height_px.has_value(), settings.band_height_px);
  drop_if(given.iterations_per_pass.has_value(), settings.iterations_per_pass);
  drop_if(situation.in_flight_given, settings.frames_in_flight);
  return settings;
}

}  // namespace

void add_tuning_settings(Settings& settings, TuningSource& source) {
  settings.start_group("Execution (never changes a result)", false);
  settings.input_path("tuning", source.file, "FILE",
                      "Results of 'vantage tune', which replace auto below; default: "
                      "vantage/tuning.json in $XDG_CONFIG_HOME or ~/.config");
  settings.flag("no-tuning", source.ignored,
                "Use the cost model, not results of 'vantage tune', for auto below");
}

fs::path file_of(const TuningSource& source) {
  if (source.ignored) {
    return {};
  }
  return source.file.empty() ? default_tuning_path().value_or(fs::path()) : fs::path(source.file);
}

AppliedTuning no_tuning(const std::string& reason) {
  AppliedTuning none;
  none.report = {{"key", nullptr}, {"reason", reason}};
  return none;
}

AppliedTuning apply_tuning(const TuningSource& source, const TuningSituation& situation,
                           const std::string& command, bool quiet) {
  if (source.ignored) {
    return no_tuning("--no-tuning");
  }
  const fs::path path = file_of(source);
  if (path.empty()) {
    return no_tuning("neither XDG_CONFIG_HOME nor HOME is an absolute path");
  }
  TuningFileContent content = read_tuning_file(path);
  std::error_code ignored_error;
  if (!source.file.empty() && !fs::exists(path, ignored_error)) {
    content.warnings.push_back(fmt::format("{}: no such file", path.string()));
  }
  if (!quiet) {
    for (const std::string& warning : content.warnings) {
      tell("{}: warning: tuning is not used: {}\n", command, warning);
    }
  }
  const TuningKey key = make_tuning_key(
      scheduler::detect_machine(), situation.match, situation.execution,
      {.width_px = situation.left.width(),
       .height_px = situation.left.height(),
       .is_8_bit_grey = is_8_bit_grey(situation.left) && is_8_bit_grey(situation.right)});
  const TuningEntry* entry = find_entry(content, key);
  const TunedPlan* plan = nullptr;
  if (entry != nullptr && entry->plan_for(situation.use)) {
    plan = &*entry->plan_for(situation.use);
  }
  AppliedTuning applied;
  if (plan == nullptr) {
    applied =
        no_tuning(content.warnings.empty() ? "no entry for this work" : content.warnings.front());
    applied.report["wanted"] = key.text();
    applied.report["file"] = path.string();
    return applied;
  }
  applied.settings = left_open(plan->settings, situation);
  applied.report = {{"key", key.text()},
                    {"file", path.string()},
                    {"use", name_of(situation.use)},
                    {"date", plan->date},
                    {"settings", as_json(applied.settings)}};
  applied.summary = fmt::format("tuned: {}", to_string(applied.settings));
  return applied;
}

}  // namespace vantage::apps
