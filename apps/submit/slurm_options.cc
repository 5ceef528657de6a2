#include "apps/submit/slurm_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <regex>

#include "engine/error.h"
#include "engine/quoted_text.h"

namespace vantage::apps {
namespace {

constexpr int kMaxArraySize = 100000;
constexpr int kMaxCpus = 1024;
constexpr int kMaxRetries = 1000;
constexpr int kMaxDrainSeconds = 86400;
constexpr int kDefaultDrainSeconds = 120;

void require_range(const std::string& option, int value, int min, int max) {
  if (value < min || value > max) {
    throw UsageError(
        fmt::format("{} is {}, expected a number from {} to {}", option, value, min, max));
  }
}

/// Accepts names that a directive of a job script can hold without quotes.
void require_name(const std::string& option, const std::string& name) {
  const bool plain = std::ranges::all_of(name, [](unsigned char letter) {
    return std::isalnum(letter) != 0 ||
           std::string("._-+,@").find(static_cast<char>(letter)) != std::string::npos;
  });
  if (!plain) {
    throw UsageError(fmt::format("{} is '{}', expected letters, digits and . _ - + , @", option,
                                 quotable(name)));
  }
}

/// Seconds of a time limit in sbatch's format; empty for other texts.
std::optional<long> to_seconds(const std::string& text) {
  static const std::regex with_days(
      "([0-9]{1,5})-([0-9]{1,9})(?::([0-9]{1,9}))?(?::([0-9]{1,9}))?");
  static const std::regex without_days("([0-9]{1,9})(?::([0-9]{1,9}))?(?::([0-9]{1,9}))?");
  std::smatch parts;
  const auto number = [&](std::size_t part) {
    return parts[part].matched ? std::stol(parts[part]) : 0L;
  };
  if (std::regex_match(text, parts, with_days)) {
    return ((number(1) * 24 + number(2)) * 60 + number(3)) * 60 + number(4);
  }
  if (!std::regex_match(text, parts, without_days)) {
    return std::nullopt;
  }
  return parts[3].matched ? (number(1) * 60 + number(2)) * 60 + number(3)
                          : number(1) * 60 + number(2);
}

}  // namespace

void SlurmOptions::validate() const {
  require_range("--shards", shards, 1, kMaxArraySize);
  require_range("--retries", retries, 0, kMaxRetries);
  require_range("--cpus", cpus.value_or(1), 1, kMaxCpus);
  require_range("--concurrent", concurrent.value_or(1), 1, kMaxArraySize);
  require_range("--drain-time", drain_seconds_or_default(), 1, kMaxDrainSeconds);
  require_name("--partition", partition);
  require_name("--account", account);
  if (!time_limit.empty() && to_seconds(time_limit).value_or(0) < 1) {
    throw UsageError(
        fmt::format("--time is '{}', expected MINUTES, HOURS:MINUTES:SECONDS or DAYS-HOURS",
                    quotable(time_limit)));
  }
  if (!memory.empty() && !std::regex_match(memory, std::regex("[1-9][0-9]{0,9}[KMGT]"))) {
    throw UsageError(
        fmt::format("--slurm-memory is '{}', expected a whole number with K, M, G or T, as in 8G",
                    quotable(memory)));
  }
  for (const std::string& option : sbatch_options) {
    if (!option.starts_with('-') || std::ranges::any_of(option, [](unsigned char letter) {
          return std::iscntrl(letter) != 0;
        })) {
      throw UsageError(
          fmt::format("--sbatch-option is '{}', expected an option of sbatch, as in --qos=long",
                      quotable(option)));
    }
  }
}

int SlurmOptions::drain_seconds_or_default() const {
  const long limit = to_seconds(time_limit).value_or(0);
  const int fitting = limit == 0
                          ? kDefaultDrainSeconds
                          : static_cast<int>(std::clamp(limit / 4, 1L, long{kDefaultDrainSeconds}));
  return drain_seconds.value_or(fitting);
}

void add_slurm_settings(Settings& settings, SlurmOptions& options) {
  settings.start_group("Slurm");
  Setting& shards = settings.integer("shards", options.shards, "N", "Number of tasks");
  shards.required = true;
  shards.get = [&options] {
    return options.shards == 0 ? SettingValue() : SettingValue(options.shards);
  };
  settings.integer("concurrent", options.concurrent, "N",
                   "Maximum number of tasks at a time; auto: all");
  settings.text("partition", options.partition, "NAME", "Partition of the cluster");
  settings.text("account", options.account, "NAME", "Account to charge");
  settings.text("time", options.time_limit, "TIME",
                "Time limit per task as for sbatch, such as 90, 12:00:00 or 1-12; a run that needs "
                "longer continues in a new job");
  settings.integer("drain-time", options.drain_seconds, "SECONDS",
                   "Time before the limit at which a task starts no more frames; auto: 120, at "
                   "most a quarter of the limit");
  settings.integer("cpus", options.cpus, "N",
                   "Processors per task; auto: --threads, else the default of the cluster");
  settings.text("slurm-memory", options.memory, "SIZE", "Memory per task, such as 8G");
  settings.integer("retries", options.retries, "N",
                   "Number of further attempts after a task has failed");
  Setting& more = settings.add("sbatch-option", "TEXT",
                               "Any other option of sbatch, such as --qos=long; repeatable");
  more.list = true;
  more.set = [&options](const SettingValue& value) {
    options.sbatch_options.clear();
    for (const SettingValue& member : to_list(value)) {
      options.sbatch_options.push_back(to_text(member));
    }
  };
  more.get = [&options] { return SettingValue(options.sbatch_options); };
  settings.path("program", options.program, "FILE",
                "Path to the vantage program on the nodes; default: this one");
}

}  // namespace vantage::apps
