#include <algorithm>
#include <memory>
#include <string>

#include "apps/commands/commands.h"
#include "apps/process/interrupt.h"
#include "apps/reports/profile_job.h"
#include "apps/settings/command_line.h"
#include "engine/error.h"
#include "engine/options/settings.h"

namespace vantage::apps {
namespace {

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
  settings.path("html", job.html, "FILE", "Write the profile as a page that stands on its own");
  settings.path("json", job.json, "FILE", "Write the profile as JSON");
  settings.flag("quiet", job.quiet, "Print the profile and errors only");
}

/// Where the profiled command starts among the arguments: the first that is neither an option nor
/// its value.
std::size_t command_start(const Arguments& arguments) {
  const Arguments flags = {"--quiet", "--help", "-h", "--help-all", "--print-config"};
  std::size_t i = 0;
  while (i < arguments.size() && arguments[i].starts_with("-")) {
    const bool has_value = arguments[i].find('=') == std::string::npos &&
                           std::ranges::find(flags, arguments[i]) == flags.end();
    i += has_value ? 2 : 1;
  }
  return std::min(i, arguments.size());
}

}  // namespace

int command_profile(const Arguments& arguments) {
  ProfileJob job;
  Settings settings("profile",
                    "Runs a command several times on several numbers of threads and tells where "
                    "the time goes: vantage profile [OPTIONS] match|run ...; its results are "
                    "thrown away.");
  add_profile_settings(settings, job);
  const auto end_of_own = arguments.begin() + static_cast<long>(command_start(arguments));
  if (!read_command_line(settings, Arguments(arguments.begin(), end_of_own))) {
    return kExitDone;
  }
  check(job);
  job.rounds.progress = job.quiet ? ProgressStyle::kNone : ProgressStyle::kAuto;
  const Arguments words(end_of_own, arguments.end());
  if (words.empty()) {
    throw UsageError("a command is missing, expected match or run with its arguments");
  }
  interrupt_flag();  // from here on there are folders to remove
  const std::unique_ptr<ProfiledCommand> command = ProfiledCommand::read(words);
  return command == nullptr ? kExitDone : run_profile(job, settings, *command);
}

}  // namespace vantage::apps
