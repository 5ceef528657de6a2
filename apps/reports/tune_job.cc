#include "apps/reports/tune_job.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "apps/commands/commands.h"
#include "apps/process/interrupt.h"
#include "apps/process/outputs.h"
#include "apps/process/progress.h"
#include "apps/process/tell.h"
#include "apps/reports/remarks.h"
#include "apps/reports/run_report.h"
#include "apps/reports/tuning_report.h"
#include "engine/error.h"
#include "engine/options/match_settings.h"
#include "engine/simd.h"
#include "engine/tuning/tuning_file.h"
#include "engine/tuning/tuning_session.h"
#include "scheduler/machine.h"
#include "scheduler/processor_use.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

fs::path tuning_path(const TuneJob& job) {
  if (!job.output.empty()) {
    return job.output;
  }
  if (const auto path = default_tuning_path()) {
    return *path;
  }
  throw Error(
      "neither XDG_CONFIG_HOME nor HOME is an absolute path, expected one of them or --output");
}

void check(const TuneJob& job, const Settings& settings) {
  if (job.list) {
    settings.refuse_idle({"size", "images", "for", "budget", "dry-run"}, "with --list");
    return;
  }
  if (!job.images) {
    throw UsageError("--size is missing, expected --size WxH");
  }
  if (job.match.disparities_auto || job.match.disparities_y_auto) {
    throw UsageError(fmt::format(
        "--disparities{} is auto, but tuning has no pair to estimate it from, expected MIN:MAX",
        job.match.disparities_auto ? "" : "-y"));
  }
}

int list_entries(const fs::path& path) {
  const TuningFileContent content = read_tuning_file(path);
  for (const std::string& warning : content.warnings) {
    tell("tune: warning: {}\n", warning);
  }
  fmt::print("{}: {} entr{}\n", path.string(), content.entries.size(),
             content.entries.size() == 1 ? "y" : "ies");
  for (const TuningEntry& entry : content.entries) {
    fmt::print("\n{}", describe(entry));
  }
  return kExitDone;
}

/// Warns that results may be wrong because other programs used the processors. `when`: such as "ran
/// while plans were measured".
void warn_of_other_programs(std::optional<double> of_others, const scheduler::Machine& machine,
                            std::string_view when) {
  constexpr double kBusyShare = 0.05;
  if (of_others.value_or(0) > kBusyShare * machine.hardware_threads) {
    tell(
        "tune: warning: the machine is busy: other programs {} ({:.1f} of {} processors on "
        "average), expected an idle machine; tune again later\n",
        when, *of_others, machine.hardware_threads);
  }
}

/// Checks for other programs before the search starts.
std::optional<double> others_at_present() {
  constexpr std::chrono::milliseconds kLook(200);
  const scheduler::ProcessorUse use;
  std::this_thread::sleep_for(kLook);
  return use.of_others();
}

std::string now_as_text() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

TuningRequest request_of(const TuneJob& job) {
  TuningRequest request;
  request.match = job.match;
  request.execution = job.common.execution;
  request.images = *job.images;
  request.images.is_8_bit_grey = job.grey;
  request.budget_seconds = job.budget_seconds;
  request.for_match = job.uses != TunedCommands::kRun;
  request.for_run = job.uses != TunedCommands::kMatch;
  return request;
}

TuningReport tune(const TuneJob& job, const TuningRequest& request) {
  Progress progress("tune", "measurements",
                    job.common.quiet ? ProgressStyle::kNone : ProgressStyle::kAuto);
  int of_uses_before = 0;
  int last = 0;
  return tune_machine(
      request,
      [&](TunedUse /*use*/, const TunerProgress& now) {
        if (now.measurements < last) {
          of_uses_before += last;
        }
        last = now.measurements;
        progress.update(of_uses_before + last, std::nullopt, 0);
      },
      &interrupt_flag());
}

}  // namespace

int run_tune(const TuneJob& job, const Settings& settings) {
  check(job, settings);
  force_instruction_set(job.common.isa);
  const fs::path path = tuning_path(job);
  if (job.list) {
    return list_entries(path);
  }
  FileChecks files(settings);
  files.add_made_file(path, "--output");
  check_common_files(job.common, files);
  const TuningRequest request = request_of(job);
  request.validate();
  RunReport report(settings.command(), reported_settings(settings, job.match));
  report.start_trace(job.common.trace);
  {
    Execution execution(job.common.execution);
    report.set_execution(execution);
    tell_threads(execution, job.common, report);
  }
  const scheduler::Machine machine = scheduler::detect_machine();
  if (job.dry_run) {
    const TuningKey key =
        make_tuning_key(machine, request.match, request.execution, request.images);
    fmt::print("{}budget   {} s\nfile     {}\n", describe(key), job.budget_seconds, path.string());
    return kExitDone;
  }
  if (!job.common.quiet) {
    warn_of_other_programs(others_at_present(), machine, "are running");
  }
  const scheduler::ProcessorUse use;
  const TuningReport tuned = report.timed_compute("tune", [&] { return tune(job, request); });
  const std::optional<double> of_others = use.of_others();
  fmt::print("{}", describe(tuned, request));
  if (!job.common.quiet) {
    std::fflush(stdout);
    warn_of_other_programs(of_others, machine, "ran while plans were measured");
  }
  SettingValue results = as_json(tuned, path);
  results["processors_used_by_others"] = of_others ? SettingValue(*of_others) : SettingValue();
  report.set_results(std::move(results));
  report.write(job.common.report);
  if (tuned.interrupted) {
    if (!job.common.quiet) {
      tell("tune: interrupted, nothing was saved\n");
    }
    return kExitInterrupted;
  }
  const TuningEntry entry = entry_of(tuned, now_as_text());
  if (!entry.match && !entry.run) {
    throw Error(fmt::format("--budget is {} s, expected enough to measure the default plan",
                            job.budget_seconds));
  }
  std::fflush(stdout);
  store_entry(path, entry);
  fmt::print("saved in {}\n", path.string());
  return kExitDone;
}

}  // namespace vantage::apps
