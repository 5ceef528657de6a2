#include "apps/reports/tuning_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace vantage::apps {
namespace {

constexpr double kMilliseconds = 1e3;

std::string faster_text(const TunedSettings& settings, double ratio) {
  if (settings == TunedSettings{}) {
    return "nothing is faster than the default plan";
  }
  return fmt::format("{}: {:.1f} % less time than the default plan", to_string(settings),
                     100 * (1 - ratio));
}

std::string describe(const TunedPlan& plan) {
  return fmt::format("{} ({:.1f} ms, default {:.1f} ms, frames of {} rows, {} measurements, {})",
                     faster_text(plan.settings, plan.ratio_to_default),
                     plan.frame_seconds * kMilliseconds, plan.default_frame_seconds * kMilliseconds,
                     plan.measured_rows, plan.measurements, plan.date);
}

std::string table(const TuningOutcome& outcome) {
  std::string text = fmt::format("  {:<52} {:>10} {:>10} {:>7}\n", "settings", "median ms",
                                 "of default", "rounds");
  for (const TuningTrial& trial : outcome.trials) {
    if (trial.frame_seconds.empty()) {
      continue;
    }
    text +=
        fmt::format("  {:<52} {:>10.2f} {:>10} {:>7}\n", to_string(trial.settings),
                    trial.median_seconds() * kMilliseconds,
                    trial.ratio_to_default ? fmt::format("{:.3f}", *trial.ratio_to_default) : "-",
                    trial.frame_seconds.size());
  }
  return text;
}

std::string measured_text(const TunedUseReport& use, const TunedImages& images) {
  std::string text =
      fmt::format("one map without refinement, {}x{} pixels", images.width_px, use.search_rows);
  if (use.frames > 1) {
    text += fmt::format(", {} frames a measurement", use.frames);
  }
  if (use.search_rows < images.height_px) {
    text += fmt::format(
        "; a frame of {} rows takes too long (the height of bands is left to the cost model)",
        images.height_px);
  }
  return text;
}

std::string result_text(const TunedUseReport& use, const TunedImages& images) {
  const TuningOutcome& outcome = use.outcome;
  std::string text = faster_text(outcome.settings, outcome.ratio_to_default);
  if (outcome.settings != TunedSettings{}) {
    text += fmt::format(" ({:.2f} ms, default {:.2f} ms; {} rounds of {}x{}, noise {:.1f} %)",
                        outcome.frame_seconds * kMilliseconds,
                        outcome.default_frame_seconds * kMilliseconds, outcome.rounds,
                        images.width_px, use.final_rows, 100 * outcome.noise);
  }
  if (outcome.settings == TunedSettings{} && outcome.rounds > 0) {
    text += fmt::format(
        " beyond noise, the best of the search included ({} round{} of {}x{}, noise {:.1f} %)",
        outcome.rounds, outcome.rounds == 1 ? "" : "s", images.width_px, use.final_rows,
        100 * outcome.noise);
  }
  if (!outcome.complete) {
    text += outcome.interrupted ? "; interrupted" : "; the budget ended the search";
  }
  return text;
}

}  // namespace

std::string_view name_of(TunedUse use) { return use == TunedUse::kMatch ? "match" : "run"; }

std::string describe(const TuningKey& key) {
  return fmt::format("machine  {}\nthreads  {}\nmethod   {}\nsize     {}\nversion  {}\n",
                     key.machine, key.threads, key.method, key.size, key.version);
}

std::string describe(const TuningEntry& entry) {
  std::string text = describe(entry.key);
  for (const TunedUse use : {TunedUse::kMatch, TunedUse::kRun}) {
    if (const std::optional<TunedPlan>& plan = entry.plan_for(use)) {
      text += fmt::format("{:<8} {}\n", name_of(use), describe(*plan));
    }
  }
  return text;
}

std::string describe(const TuningReport& report, const TuningRequest& request) {
  std::string text = describe(report.key);
  for (const TunedUseReport& use : report.uses) {
    text += fmt::format("\n{}: {}\n{}", name_of(use.use), measured_text(use, request.images),
                        table(use.outcome));
  }
  text += "\n";
  for (const TunedUseReport& use : report.uses) {
    text += fmt::format("{}: {}\n", name_of(use.use), result_text(use, request.images));
  }
  return text;
}

SettingValue as_json(const TunedSettings& settings) {
  SettingValue json = SettingValue::object();
  for (const TuningCoordinate& coordinate : kTuningCoordinates) {
    if (const std::optional<int>& value = settings.*coordinate.field) {
      json[std::string(coordinate.name)] = *value;
    }
  }
  return json;
}

SettingValue as_json(const TuningReport& report, const std::filesystem::path& file) {
  SettingValue json = {
      {"key", report.key.text()}, {"file", file.string()}, {"interrupted", report.interrupted}};
  for (const TunedUseReport& use : report.uses) {
    const TuningOutcome& outcome = use.outcome;
    SettingValue trials = SettingValue::array();
    for (const TuningTrial& trial : outcome.trials) {
      trials.push_back(
          {{"settings", as_json(trial.settings)},
           {"coordinate", trial.coordinate},
           {"frame_seconds", trial.frame_seconds},
           {"ratio_to_default",
            trial.ratio_to_default ? SettingValue(*trial.ratio_to_default) : SettingValue()}});
    }
    json[std::string(name_of(use.use))] = {{"settings", as_json(outcome.settings)},
                                           {"frame_seconds", outcome.frame_seconds},
                                           {"default_frame_seconds", outcome.default_frame_seconds},
                                           {"ratio_to_default", outcome.ratio_to_default},
                                           {"final_rounds", outcome.rounds},
                                           {"final_noise", outcome.noise},
                                           {"measurements", outcome.measurements},
                                           {"seconds", outcome.elapsed_seconds},
                                           {"complete", outcome.complete},
                                           {"search_rows", use.search_rows},
                                           {"final_rows", use.final_rows},
                                           {"frames_per_measurement", use.frames},
                                           {"tried", trials}};
  }
  return json;
}

}  // namespace vantage::apps
