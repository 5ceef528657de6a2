#include "apps/reports/profile_job.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <set>

#include "apps/commands/commands.h"
#include "apps/pages/profile_page.h"
#include "apps/process/interrupt.h"
#include "apps/process/outputs.h"
#include "apps/process/tell.h"
#include "apps/reports/profile_report.h"
#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/profiling/profile_advice.h"
#include "engine/profiling/profile_figures.h"
#include "engine/profiling/profile_json.h"
#include "engine/simd.h"
#include "engine/thread_placement.h"
#include "scheduler/machine.h"

namespace vantage::apps {
namespace {

constexpr double kCeilingSeconds = 1.5;  // for each number of threads

void check_files(const ProfileJob& job, const Settings& settings, const ProfiledCommand& command) {
  FileChecks files(settings);
  for (const std::string& input : command.inputs()) {
    files.add_input(input);
  }
  files.add_output(job.html, "--html", OutputKind::kPage);
  files.add_output(job.json, "--json", OutputKind::kText);
}

/// Fewest first, none twice.
std::vector<int> thread_counts(const ProfileJob& job, const ProfiledCommand& command) {
  std::vector<int> counts = job.threads;
  const ExecutionOptions& execution = command.common().execution;
  const scheduler::Machine machine = scheduler::detect_machine();
  const int max = thread_count(execution, machine);
  if (execution.executor == scheduler::ExecutorKind::kSerial) {
    counts = {1};
  } else if (counts.empty()) {
    for (int threads = 1; threads < max; threads *= 2) {
      counts.push_back(threads);
    }
    counts.push_back(max);
  }
  for (int& count : counts) {
    const ExecutionOptions asked{.threads = count};
    for (const Remark& remark : thread_remarks(asked, machine)) {
      if (!job.quiet) {
        tell("profile: {}\n", with_dashes(remark.text));
      }
    }
    count = thread_count(asked, machine);
  }
  const std::set<int> distinct(counts.begin(), counts.end());
  return {distinct.begin(), distinct.end()};
}

std::string start_time_text() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

std::vector<MachineCeilings> measure_all_ceilings(const std::vector<int>& counts,
                                                  ExecutionOptions options,
                                                  const std::atomic<bool>& stop) {
  std::vector<MachineCeilings> all;
  for (const int threads : counts) {
    if (!stop.load()) {
      options.threads = threads;
      Execution execution(options);
      all.push_back(measure_ceilings(execution, kCeilingSeconds));
    }
  }
  return all;
}

Profile make_profile(const ProfiledCommand& command, const std::vector<Contestant>& contestants) {
  const scheduler::Machine machine = scheduler::detect_machine();
  const Contestant& max = contestants.back();
  Profile profile;
  profile.version = max.version;
  profile.command = command.text();
  profile.date = start_time_text();
  profile.processor = machine.processor;
  profile.isa = max.isa;
  profile.hardware_threads = machine.hardware_threads;
  std::vector<WallTimes> walls;
  for (const Contestant& one : contestants) {
    profile.thread_counts.push_back(summarise_runs(one.threads, one.runs));
    WallTimes& times = walls.emplace_back(WallTimes{one.threads, {}});
    for (const RunMeasurement& run : one.runs) {
      times.wall_s.push_back(run.wall_s);
    }
  }
  profile.speed_ups = speed_ups(walls);
  profile.serial_fraction = amdahl_fit(profile.speed_ups);
  profile.advice = profile_advice(profile, median_steps(max.runs), command.choices());
  const RunMeasurement& median = max.runs[median_run(max.runs)];
  profile.peak_memory_bytes =
      static_cast<std::uint64_t>(profile.thread_counts.back().peak_memory_bytes.max);
  profile.memory = median.memory;
  std::ranges::stable_sort(profile.memory, std::ranges::greater{}, &MemoryOwner::bytes);
  profile.timeline = max.timeline;
  profile.timeline_s = max.timeline_s;
  return profile;
}

void write_files(const ProfileJob& job, const Profile& profile) {
  if (!job.json.empty()) {
    write_text_file(job.json, profile_json(profile));
  }
  if (!job.html.empty()) {
    write_text_file(job.html, make_profile_page(profile));
  }
}

void print_before(const ProfiledCommand& command) {
  for (const std::string& remark : command.remarks()) {
    tell("profile: {}\n", remark);
  }
  tell("profile: measuring what the machine can do\n");
}

int profile(const ProfileJob& job, ProfiledCommand& command) {
  const std::vector<int> counts = thread_counts(job, command);
  force_instruction_set(command.common().isa);
  const std::atomic<bool>& interrupted = interrupt_flag();
  if (!job.quiet) {
    print_before(command);
  }
  const std::vector<MachineCeilings> ceilings =
      measure_all_ceilings(counts, command.common().execution, interrupted);
  std::vector<Contestant> contestants;
  for (const int threads : counts) {
    contestants.push_back({.threads = threads, .keeps_timeline = threads == counts.back()});
  }
  if (interrupted.load() || !run_rounds(command, job.rounds, contestants, interrupted)) {
    if (!job.quiet) {
      tell("profile: interrupted, nothing is kept\n");
    }
    return kExitInterrupted;
  }
  Profile profile = make_profile(command, contestants);
  profile.ceilings = ceilings;
  const int rounds = profile.thread_counts.front().runs;
  if (rounds < job.rounds.rounds && !job.quiet) {
    tell("profile: the budget ended it after {} of {} rounds\n", rounds, job.rounds.rounds);
  }
  write_files(job, profile);
  fmt::print("{}", describe(profile));
  return kExitDone;
}

}  // namespace

void check(const ProfileJob& job) {
  constexpr int kMaxRuns = 1000;
  if (job.rounds.rounds < 1 || job.rounds.rounds > kMaxRuns) {
    throw UsageError(
        fmt::format("--runs is {}, expected a number from 1 to {}", job.rounds.rounds, kMaxRuns));
  }
  require_above_0("budget", job.rounds.budget_s);
  for (const int threads : job.threads) {
    ExecutionOptions{.threads = threads}.validate();
  }
}

int run_profile(const ProfileJob& job, const Settings& settings, ProfiledCommand& command) {
  check_files(job, settings, command);
  try {
    return profile(job, command);
  } catch (const RunFailure& failure) {
    tell("{}\n", failure.what());
    return failure.exit_code();
  }
}

}  // namespace vantage::apps
