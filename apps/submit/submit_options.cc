#include "apps/submit/submit_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <regex>
#include <utility>

#include "apps/inputs/input_limits.h"
#include "apps/submit/engine_table.h"
#include "engine/error.h"
#include "engine/quoted_text.h"

namespace vantage::apps {
namespace {

constexpr int kMaxTasks = 100000;
constexpr int kMaxCpus = 1024;
constexpr long kDay_s = 86400;

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

void require_options(const std::string& option, const std::vector<std::string>& texts,
                     const std::string& expected) {
  for (const std::string& text : texts) {
    if (!text.starts_with('-') || printable(text) != text) {
      throw UsageError(fmt::format("{} is '{}', expected {}", option, quotable(text), expected));
    }
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

void add_time_setting(Settings& settings, std::optional<long>& field) {
  constexpr long kMin_s = 60;  // of AWS Batch; Slurm rounds up to minutes
  Setting& time =
      settings.add("time", "TIME",
                   "Time limit per task as for sbatch, such as 90, 12:00:00 or 1-12; what needs "
                   "longer goes on in "
                   "a new task. auto: as the plan of the manifest says, else that of the engine");
  time.words = {"auto"};
  time.set = [&field](const SettingValue& value) {
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    field = text == "auto" ? std::nullopt : to_seconds(text);
    if (text != "auto" && field.value_or(0) < kMin_s) {
      reject_value(text, "at least a minute as MINUTES, HOURS:MINUTES:SECONDS or DAYS-HOURS");
    }
  };
  time.get = [&field] { return SettingValue(field ? duration_text(*field) : "auto"); };
}

void add_list_setting(Settings& settings, const std::string& name, std::vector<std::string>& field,
                      const std::string& value_name, const std::string& help) {
  Setting& setting = settings.add(name, value_name, help);
  setting.list = true;
  setting.set = [&field](const SettingValue& value) {
    field.clear();
    for (const SettingValue& member : to_list(value)) {
      field.push_back(to_text(member));
    }
  };
  setting.get = [&field] { return SettingValue(field); };
}

void add_task_settings(Settings& settings, SubmitOptions& options) {
  settings.start_group("Tasks", false);
  std::vector<std::pair<std::string_view, BatchEngine>> names;
  for (const EngineEntry& entry : engines()) {
    names.emplace_back(entry.name, entry.engine);
  }
  settings.choice("engine", options.engine, names, "What runs the tasks");
  settings.flag("go", options.go, "Submit; without it, files are written and commands printed");
  settings.integer("tasks", options.tasks, "N",
                   "Number of tasks of a manifest; auto: one per job of its plan, at most 1000");
  Setting& shards = settings.integer("shards", options.shards, "N",
                                     "Number of tasks of one run, instead of a manifest (Slurm)");
  shards.get = [&options] {
    return options.shards == 0 ? SettingValue() : SettingValue(options.shards);
  };
  settings.integer("concurrent", options.requests.concurrent, "N",
                   "Maximum number of tasks at a time; auto: all");
  settings.integer("cpus", options.requests.cores, "N",
                   "Processors per task; auto: --threads, else 4; of one run the default of the "
                   "cluster");
  add_size_setting(
      settings, "task-memory", options.requests.memory_bytes,
      "Memory per task, such as 8G; auto: as the plan of the manifest says; of one run "
      "the default of the cluster");
  add_time_setting(settings, options.requests.time_limit_s);
  settings.integer("drain-time", options.drain_s, "SECONDS",
                   "Time in which a task that has to end finishes its work or hands it back; auto: "
                   "120, at most a quarter of the time limit");
  settings.integer("retries", options.requests.retries, "N",
                   "Number of further attempts after a task has failed");
  settings.path("program", options.program, "FILE",
                "Path to the vantage program where tasks run; default: this one, or vantage in an "
                "image");
}

void add_engine_settings(Settings& settings, SubmitOptions& options) {
  settings.start_group("Options of engines", false);
  settings.text("partition", options.partition, "NAME", "Partition of the cluster (Slurm)");
  settings.text("account", options.account, "NAME", "Account to charge (Slurm)");
  add_list_setting(settings, "sbatch-option", options.sbatch_options, "TEXT",
                   "Any other option of sbatch, such as --qos=long; repeatable");
  settings.text("queue", options.queue, "NAME", "Queue (SGE, AWS Batch)");
  settings.text("parallel-environment", options.parallel_environment, "NAME",
                "Parallel environment that gives all processors on one host (SGE)");
  settings.text("memory-resource", options.memory_resource, "NAME",
                "Resource that --task-memory is requested as, divided by the processors (SGE)");
  add_list_setting(settings, "qsub-option", options.qsub_options, "TEXT",
                   "Any other option of qsub, such as '-l arch=lx-amd64'; repeatable");
  settings.text("image", options.image, "NAME",
                "Container image with vantage (Kubernetes, AWS Batch)");
  settings.text("service-account", options.service_account, "NAME",
                "Service account of the pods (Kubernetes)");
  add_list_setting(settings, "volume-claim", options.volume_claims, "NAME:/PATH",
                   "A persistent volume claim and where pods see it (Kubernetes); repeatable");
  settings.text("job-role", options.job_role, "ARN", "Role of the tasks, for S3 (AWS Batch)");
  settings.text("execution-role", options.execution_role, "ARN",
                "Role that fetches the image and writes logs (AWS Batch)");
}

}  // namespace

void SubmitOptions::validate() const {
  if (shards != 0) {
    require_range("--shards", shards, 1, kMaxTasks);
  }
  require_range("--tasks", tasks.value_or(1), 1, engine_entry(engine).max_tasks);
  require_range("--retries", requests.retries, 0, engine_entry(engine).max_retries);
  require_range("--cpus", requests.cores.value_or(1), 1, kMaxCpus);
  require_range("--concurrent", requests.concurrent.value_or(1), 1, kMaxTasks);
  require_range("--drain-time", drain_s_or_default(), 1,
                static_cast<int>(std::min(kDay_s, requests.time_limit_s.value_or(kDay_s) - 1)));
  require_name("--partition", partition);
  require_name("--account", account);
  if (engine == BatchEngine::kSge) {
    require_name("--queue", queue);
  }
  require_name("--parallel-environment", parallel_environment);
  require_name("--memory-resource", memory_resource);
  require_options("--sbatch-option", sbatch_options, "an option of sbatch, as in --qos=long");
  require_options("--qsub-option", qsub_options, "an option of qsub, as in '-l arch=lx-amd64'");
  for (const std::string& claim : volume_claims) {
    if (!std::regex_match(claim, std::regex("[a-z0-9][a-z0-9.-]*:/[^:]*"))) {
      throw UsageError(fmt::format("--volume-claim is '{}', expected NAME:/PATH, as in films:/data",
                                   quotable(claim)));
    }
  }
}

int SubmitOptions::drain_s_or_default() const {
  const long quarter = std::max(1L, requests.time_limit_s.value_or(kDay_s) / 4);
  return drain_s.value_or(static_cast<int>(std::min(long{engine_entry(engine).drain_s}, quarter)));
}

void add_submit_settings(Settings& settings, SubmitOptions& options) {
  add_task_settings(settings, options);
  add_engine_settings(settings, options);
}

std::string duration_text(long seconds) {
  const long days = seconds / kDay_s;
  return fmt::format("{}{:02}:{:02}:{:02}", days > 0 ? fmt::format("{}-", days) : "",
                     seconds / 3600 % 24, seconds / 60 % 60, seconds % 60);
}

}  // namespace vantage::apps
