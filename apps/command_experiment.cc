#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "apps/commands.h"
#include "apps/experiment_files.h"
#include "apps/interrupt.h"
#include "apps/option_groups.h"
#include "apps/outputs.h"
#include "apps/progress.h"
#include "apps/run_report.h"
#include "apps/settings.h"
#include "apps/tell.h"
#include "engine/sequence/sequence_layout.h"
#include "engine/simd.h"

namespace vantage::apps {
namespace {

constexpr std::string_view kNoise = "noise";

struct ExperimentJob {
  std::string name;
  BookExperimentOptions options;
  CommonOptions common;
  std::string output;
};

void add_experiment_settings(Settings& settings, ExperimentJob& job) {
  settings.start_group("Files");
  Setting& name =
      settings.positional("name", job.name,
                          "noise: error of the methods by noise (Figs. 6.16, 6.17) and by "
                          "iterations (6.10), and the support of the membrane (6.9)");
  name.required = true;
  name.path = PathRole::kNone;
  name.set = [&job](const SettingValue& value) {
    if (value != kNoise) {
      reject_value(value, kNoise);
    }
    job.name = to_text(value);
  };
  Setting& output = settings.path("output", job.output, "DIR", "Output folder");
  output.short_name = 'o';
  output.required = true;

  settings.start_group("Experiment");
  settings.integer("size", job.options.size_px, "PX", "Width and height of the synthetic images");
  settings.integer("iterations", job.options.iterations, "N",
                   "Number of iterations of the iterative methods in the comparison by noise");
  Setting& pairs = settings.add("pairs", "LIST", "Pairs to compare by noise");
  pairs.list = true;
  pairs.set = [&job](const SettingValue& value) {
    std::vector<std::string> names;
    for (const SettingValue& member : to_list(value)) {
      for (const std::string& pair : split(to_text(member), ',')) {
        if (std::ranges::find(names, pair) == names.end()) {
          names.push_back(pair);
        }
      }
    }
    job.options.pairs = std::move(names);
  };
  pairs.get = [&job] { return job.options.pairs; };
  add_seed_setting(settings, job.options.seed);
}

/// The rows of noise.csv, for the report.
SettingValue describe_runs(const std::vector<ExperimentRun>& runs) {
  SettingValue rows = SettingValue::array();
  for (const ExperimentRun& run : runs) {
    rows.push_back({{"pair", run.pair},
                    {"method", experiment_method_name(run.method)},
                    {"iterations", run.iterations},
                    {"noise_sigma", run.noise_sigma},
                    {"mean_absolute_px", run.scores.average_px},
                    {"rms_px", run.scores.rms_px},
                    {"bad_percent", run.scores.bad_0_5_percent}});
  }
  return rows;
}

}  // namespace

int command_experiment(const Arguments& arguments) {
  ExperimentJob job;
  Settings settings("experiment",
                    "Reproduces figures of the book: tables (CSV), charts (SVG), images.");
  add_experiment_settings(settings, job);
  add_common_settings(settings, job.common);
  settings.set_short_help(
      {"name", "output", "size", "iterations", "pairs", "seed", "threads", "quiet"},
      {"vantage experiment noise -o figures",
       "vantage experiment noise --size 128 --iterations 20 -o figures"});
  if (!settings.read(arguments)) {
    return kExitDone;
  }
  job.options.validate();
  job.common.execution.validate();
  FileChecks files(settings);
  for (const char* name : {"noise.csv", "iterations.csv", "support.csv"}) {
    files.add_made_file(std::filesystem::path(job.output) / name, "--output");
  }
  check_common_files(job.common, files);
  RunReport report(settings.command(), settings.values());
  report.start_trace(job.common.trace);
  force_instruction_set(job.common.isa);
  Execution execution(job.common.execution);
  report.set_execution(execution);
  const std::filesystem::path folder = job.output;
  make_folder(folder);

  const std::atomic<bool>& interrupted = interrupt_flag();
  std::vector<ExperimentRun> noise_runs;
  std::vector<ExperimentRun> iteration_runs;
  {
    Progress progress("experiment noise", "runs",
                      job.common.quiet ? ProgressStyle::kNone : ProgressStyle::kAuto);
    const int noise_total =
        static_cast<int>(job.options.pairs.size() * kExperimentNoise.size() * kNoiseMethods.size());
    const int all =
        noise_total + static_cast<int>(kIterationMethods.size() * kExperimentIterations.size());
    const auto watch_from = [&](int first) {
      return ExperimentWatch{
          [&progress, first, all](int done, int) { progress.update(first + done, all, 0); },
          &interrupted};
    };
    report.timed_compute(
        "noise", [&] { noise_runs = run_noise_experiment(job.options, execution, watch_from(0)); });
    report.timed_compute("iterations", [&] {
      iteration_runs = run_iteration_experiment(job.options, execution, watch_from(noise_total));
    });
  }
  if (noise_runs.empty() || iteration_runs.empty()) {
    if (!job.common.quiet) {
      tell("experiment: interrupted\n");
    }
    return kExitInterrupted;
  }
  const double support_difference = report.timed_file_access("write", [&] {
    write_noise_files(folder, noise_runs);
    write_iteration_files(folder, iteration_runs);
    return write_support_files(folder);
  });

  report.set_results({{"noise", describe_runs(noise_runs)},
                      {"iterations", describe_runs(iteration_runs)},
                      {"support_largest_difference", support_difference}});
  report.write(job.common.report);
  if (!job.common.quiet) {
    tell("experiment noise: {} runs, {}x{} pixels -> {}\n",
         noise_runs.size() + iteration_runs.size(), job.options.size_px, job.options.size_px,
         job.output);
    report.print_summary();
  }
  return kExitDone;
}

}  // namespace vantage::apps
