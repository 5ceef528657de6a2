#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <iterator>
#include <optional>
#include <string>

#include "apps/commands/commands.h"
#include "apps/pages/profile_page.h"
#include "apps/process/child_process.h"
#include "apps/process/interrupt.h"
#include "apps/process/outputs.h"
#include "apps/process/tell.h"
#include "apps/reports/profile_report.h"
#include "apps/reports/profile_rounds.h"
#include "apps/reports/profiled_command.h"
#include "apps/settings/command_line.h"
#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/options/settings.h"
#include "engine/profiling/profile_advice.h"
#include "engine/profiling/profile_comparison.h"
#include "engine/profiling/profile_figures.h"
#include "engine/profiling/profile_json.h"
#include "engine/simd.h"
#include "scheduler/machine.h"

namespace vantage::apps {
namespace {

constexpr double kCeilingSeconds = 1.5;  // for each number of threads

struct ProfileJob {
  RoundOptions rounds;
  std::vector<int> threads;  ///< empty: 1, 2, 4 … up to all
  std::string against;       ///< another program; empty: none
  std::string html;
  std::string json;
  bool compare = false;
  std::vector<std::string> profiles;  ///< to compare
  bool quiet = false;
};

void add_profile_settings(Settings& settings, ProfileJob& job) {
  settings.start_group("Profile");
  settings.integer("runs", job.rounds.rounds, "N",
                   "Measured runs per number of threads, after one warm-up");
  Setting& threads = settings.add("threads", "N,N,...",
                                  "Numbers of threads to run on; auto: 1, 2, 4 and so on up to "
                                  "the command's own");
  threads.list = true;
  threads.set = [&job](const SettingValue& value) {
    job.threads.clear();
    for (const SettingValue& member : to_list(value)) {
      for (const std::string& number :
           split(member.is_string() ? to_text(member) : member.dump(), ',')) {
        if (number != "auto") {
          job.threads.push_back(to_integer(number));
        }
      }
    }
  };
  threads.get = [&job] {
    return job.threads.empty() ? SettingValue("auto") : SettingValue(job.threads);
  };
  settings.number("budget", job.rounds.budget_s, "SECONDS",
                  "Do not start a round that would end later; the first round always runs", "none");
  settings.path("against", job.against, "PROGRAM",
                "Another build of vantage, run in turn with this one and compared with it");
  settings.path("html", job.html, "FILE", "Write the profile as a page that stands on its own");
  settings.path("json", job.json, "FILE", "Write the profile as JSON, which --compare reads");
  settings.flag("compare", job.compare,
                "Compare two profiles that --json has kept, instead of making one");
  Setting& profiles = settings.add("profiles", "PROFILE", "With --compare: A.json B.json");
  profiles.positional = true;
  profiles.path = PathRole::kInput;
  profiles.list = true;
  profiles.set = [&job](const SettingValue& value) {
    job.profiles = value.get<std::vector<std::string>>();
  };
  profiles.get = [&job] { return job.profiles; };
  settings.flag("quiet", job.quiet, "Print the profile and errors only");
}

/// Where the profiled command starts among the arguments: the first that is neither an option nor
/// its value. All of them with --compare.
std::size_t command_start(const Arguments& arguments) {
  const Arguments flags = {"--compare", "--quiet", "--help", "-h", "--help-all", "--print-config"};
  if (std::ranges::find(arguments, "--compare") != arguments.end()) {
    return arguments.size();
  }
  std::size_t i = 0;
  while (i < arguments.size() && arguments[i].starts_with("-")) {
    const bool has_value = arguments[i].find('=') == std::string::npos &&
                           std::ranges::find(flags, arguments[i]) == flags.end();
    i += has_value ? 2 : 1;
  }
  return std::min(i, arguments.size());
}

void check(const ProfileJob& job) {
  constexpr int kMaxRuns = 1000;
  if (job.rounds.rounds < 1 || job.rounds.rounds > kMaxRuns) {
    throw UsageError(
        fmt::format("--runs is {}, expected a number from 1 to {}", job.rounds.rounds, kMaxRuns));
  }
  require_above_0("budget", job.rounds.budget_s);
  if (!job.against.empty() && resolved(job.against) == resolved(path_of_this_program())) {
    throw UsageError("--against is this program itself, expected another one");
  }
  for (const int threads : job.threads) {
    ExecutionOptions{.threads = threads}.validate();
  }
}

/// `command`: null with --compare.
void check_files(const ProfileJob& job, const Settings& settings, const ProfiledCommand* command) {
  FileChecks files(settings);
  if (command != nullptr) {
    std::ranges::for_each(command->inputs(), [&](const auto& input) { files.add_input(input); });
  }
  files.add_output(job.html, "--html", OutputKind::kPage);
  files.add_output(job.json, "--json", OutputKind::kText);
}

int compare(const ProfileJob& job, const Settings& settings) {
  settings.refuse_idle({"runs", "threads", "budget"},
                       "with --compare, which only prints what two files hold");
  if (job.profiles.size() != 2) {
    throw UsageError(fmt::format("--compare is given {} file{}, expected two: A.json B.json",
                                 job.profiles.size(), job.profiles.size() == 1 ? "" : "s"));
  }
  if (!job.html.empty() || !job.json.empty() || !job.against.empty()) {
    throw UsageError(
        fmt::format("--{} cannot go with --compare, which only prints what two files hold",
                    !job.html.empty()   ? "html"
                    : !job.json.empty() ? "json"
                                        : "against"));
  }
  const Profile first = read_profile(job.profiles[0]);
  const Profile second = read_profile(job.profiles[1]);
  fmt::print("{}", describe(compare_profiles(first, second), job.profiles[0], job.profiles[1]));
  return kExitDone;
}

/// Fewest first.
std::vector<int> thread_counts(const ProfileJob& job, const ProfiledCommand& command) {
  std::vector<int> counts = job.threads;
  const ExecutionOptions& execution = command.common().execution;
  const int max = thread_count(execution, scheduler::detect_machine());
  if (execution.executor == scheduler::ExecutorKind::kSerial) {
    counts = {1};
  } else if (counts.empty()) {
    for (int threads = 1; threads < max; threads *= 2) {
      counts.push_back(threads);
    }
    counts.push_back(max);
  }
  std::ranges::sort(counts);
  counts.erase(std::ranges::unique(counts).begin(), counts.end());
  return counts;
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

/// From the runs of one program.
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
  profile.hardware = {summarise_counts(max.runs), max.counters_absence};
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

/// Of all programs and numbers of threads, in the order of a round.
std::vector<Contestant> contestants_of(const ProfileJob& job, const std::vector<int>& counts) {
  std::vector<Contestant> all;
  const auto add = [&](const std::string& program, int threads) {
    Contestant& one = all.emplace_back();
    one.program = program;
    one.threads = threads;
    one.keeps_timeline = threads == counts.back();
  };
  for (const int threads : counts) {
    if (!job.against.empty()) {
      add(job.against, threads);
    }
    add(path_of_this_program(), threads);
  }
  return all;
}

Profile profile_of(const std::string& program, const ProfiledCommand& command,
                   const std::vector<Contestant>& contestants,
                   const std::vector<MachineCeilings>& ceilings) {
  std::vector<Contestant> of_program;
  std::ranges::copy_if(contestants, std::back_inserter(of_program),
                       [&](const Contestant& one) { return one.program == program; });
  Profile profile = make_profile(command, of_program);
  profile.ceilings = ceilings;
  return profile;
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
  std::vector<Contestant> contestants = contestants_of(job, counts);
  if (interrupted.load() || !run_rounds(command, job.rounds, contestants, interrupted)) {
    if (!job.quiet) {
      tell("profile: interrupted, nothing is kept\n");
    }
    return kExitInterrupted;
  }
  const Profile profile = profile_of(path_of_this_program(), command, contestants, ceilings);
  const int rounds = profile.thread_counts.front().runs;
  if (rounds < job.rounds.rounds && !job.quiet) {
    tell("profile: the budget ended it after {} of {} rounds\n", rounds, job.rounds.rounds);
  }
  write_files(job, profile);
  fmt::print("{}", describe(profile));
  if (!job.against.empty()) {
    const Profile other = profile_of(job.against, command, contestants, ceilings);
    fmt::print("\n{}",
               describe(compare_profiles(other, profile), job.against, path_of_this_program()));
  }
  return kExitDone;
}

}  // namespace

int command_profile(const Arguments& arguments) {
  ProfileJob job;
  Settings settings("profile",
                    "Runs a command several times on several numbers of threads and tells where "
                    "the time goes: vantage profile [OPTIONS] match|run ...; its results are "
                    "thrown away.");
  add_profile_settings(settings, job);
  const std::size_t begin = command_start(arguments);
  const auto end_of_own = arguments.begin() + static_cast<long>(begin);
  if (!read_command_line(settings, Arguments(arguments.begin(), end_of_own))) {
    return kExitDone;
  }
  check(job);
  if (job.compare) {
    check_files(job, settings, nullptr);
    return compare(job, settings);
  }
  const Arguments words(end_of_own, arguments.end());
  if (words.empty()) {
    throw UsageError("a command is missing, expected match or run with its arguments");
  }
  interrupt_flag();  // from here on there are folders to remove
  const std::unique_ptr<ProfiledCommand> command = ProfiledCommand::read(words);
  if (command == nullptr) {
    return kExitDone;
  }
  check_files(job, settings, command.get());
  job.rounds.progress = job.quiet ? ProgressStyle::kNone : ProgressStyle::kAuto;
  try {
    return profile(job, *command);
  } catch (const RunFailure& failure) {
    tell("{}\n", failure.what());
    return failure.exit_code();
  }
}

}  // namespace vantage::apps
