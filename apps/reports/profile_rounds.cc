#include "apps/reports/profile_rounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>

#include "apps/process/child_process.h"
#include "apps/reports/trace_file.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/json_text.h"
#include "engine/profiling/timeline.h"
#include "engine/seconds_since.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

std::map<std::string, RunMeasurement::Part> parts_in(const SettingValue& names) {
  std::map<std::string, RunMeasurement::Part> parts;
  for (const auto& [name, part] : names.items()) {
    parts[name] = {part.at("seconds"), part.at("count"), part.at("processor_seconds")};
  }
  return parts;
}

void take_trace(const SettingValue& trace, RunMeasurement& run) {
  // Not seconds.wall, in which the trace is written.
  run.wall_s = trace.at("wall_seconds");
  run.work_share = trace.at("work_share");
  for (const SettingValue& thread : trace.at("threads")) {
    run.workers.push_back({thread.at("name"), thread.at("is_in_pool"), thread.at("work_seconds"),
                           thread.at("wait_seconds")});
  }
  for (const auto& [name, stage] : trace.at("stages").items()) {
    run.stages[name] = {stage.at("seconds"), stage.at("columns"),    stage.at("own_columns"),
                        stage.at("cells"),   stage.at("operations"), stage.at("bytes")};
  }
  run.parts = parts_in(trace.at("work"));
  run.waits = parts_in(trace.at("waits"));
  const SettingValue& causes = trace.at("waiting_for");
  run.waiting_for = {causes.at("reading"), causes.at("computing"), causes.at("writing"),
                     causes.at("nothing")};
}

RunMeasurement measurement_in(const SettingValue& report) {
  RunMeasurement run;
  take_trace(report.at("trace"), run);
  for (const auto& [step, seconds] : report.at("seconds").at("stages").items()) {
    run.steps[step] = seconds;
  }
  run.compute_s = report.at("seconds").at("compute");
  run.cells_per_s = report.at("cells_per_second");
  run.peak_memory_bytes = report.at("peak_memory_bytes");
  if (report.contains("results") && report.at("results").contains("frames")) {
    const SettingValue& results = report.at("results");
    run.frames = results.at("frames");
    run.frames_per_s = run.frames / run.wall_s;
    for (const auto& [step, seconds] : results.at("processor_seconds_per_frame").items()) {
      const double of_run_s = run.frames * seconds.get<double>();
      run.frame_steps[step] = {of_run_s, run.frames, of_run_s};
    }
  }
  if (report.contains("memory")) {
    for (const auto& [owner, bytes] : report.at("memory").at("owners").items()) {
      run.memory.push_back({owner, bytes});
    }
  }
  return run;
}

std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of('\n');
  if (end == std::string::npos) {
    return "";
  }
  const std::size_t before = text.find_last_of('\n', end);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  return text.substr(begin, end + 1 - begin);
}

void require_success(const ProgramResult& result, const ProfiledCommand& command, int threads) {
  if (result.exit_code == kExitDone || result.exit_code == kExitSkipped) {
    return;
  }
  std::string line = last_line(result.err);
  if (result.exit_code > 128 && result.exit_code != kExitInterrupted) {
    line = fmt::format("vantage profile: {} on {} thread{} was ended by signal {}", command.name(),
                       threads, threads == 1 ? "" : "s", result.exit_code - 128);
  }
  throw RunFailure(line, result.exit_code);
}

/// Where the runs put what they tell.
class RunFiles {
 public:
  explicit RunFiles(const fs::path& place) : folder_(place) {}
  [[nodiscard]] std::string job() const { return (folder_.path() / "job.toml").string(); }
  [[nodiscard]] std::string report() const { return (folder_.path() / "report.json").string(); }
  [[nodiscard]] std::string trace(std::size_t run) const {
    return (folder_.path() / fmt::format("trace-{}.json", run)).string();
  }

 private:
  ScratchFolder folder_;
};

/// One run; false when `stop` was raised.
bool run_once(ProfiledCommand& command, const RunFiles& files, const std::string& trace,
              Contestant& contestant, const std::atomic<bool>& stop) {
  write_text_file(files.job(), command.job_file(contestant.threads, files.report(), trace));
  const ProgramResult result =
      run_program({path_of_this_program(), command.name(), "--config", files.job()}, &stop);
  command.clear_results();
  if (stop.load()) {
    return false;
  }
  require_success(result, command, contestant.threads);
  RunMeasurement run;
  try {
    const SettingValue report = read_json_file(files.report());
    contestant.version = report.at("version");
    contestant.isa = report.at("isa");
    run = measurement_in(report);
  } catch (const SettingValue::exception& error) {
    throw Error(
        fmt::format("{}: lacks what a profile is made of ({})", files.report(), error.what()));
  }
  contestant.runs.push_back(std::move(run));
  return true;
}

void take_timeline(const RunFiles& files, Contestant& contestant) {
  const StoredTrace stored = read_trace(files.trace(median_run(contestant.runs)));
  contestant.timeline = timeline_of(stored.trace);
  contestant.timeline_s = static_cast<double>(stored.trace.wall_ns) * 1e-9;
}

}  // namespace

bool run_rounds(ProfiledCommand& command, const RoundOptions& options,
                std::vector<Contestant>& contestants, const std::atomic<bool>& stop) {
  const RunFiles files(command.place());
  Progress progress("profile", "runs", options.progress);
  const int total = (options.rounds + 1) * static_cast<int>(contestants.size());
  const Clock::time_point begin = Clock::now();
  const auto unwanted_trace = static_cast<std::size_t>(options.rounds);
  int done = 0;
  for (int round = -1; round < options.rounds; ++round) {
    const Clock::time_point round_start = Clock::now();
    for (Contestant& contestant : contestants) {
      const bool keeps_trace = round >= 0 && contestant.keeps_timeline;
      const std::string trace =
          files.trace(keeps_trace ? static_cast<std::size_t>(round) : unwanted_trace);
      if (!run_once(command, files, trace, contestant, stop)) {
        return false;
      }
      if (round < 0) {
        contestant.runs.clear();
      }
      progress.update(++done, total, 0);
    }
    const double left_s = options.budget_s.value_or(1e300) - seconds_since(begin);
    if (round >= 0 && left_s < seconds_since(round_start)) {
      break;
    }
  }
  for (Contestant& contestant : contestants) {
    if (contestant.keeps_timeline) {
      take_timeline(files, contestant);
    }
  }
  return true;
}

}  // namespace vantage::apps
