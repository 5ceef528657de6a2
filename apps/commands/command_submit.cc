#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/commands/commands.h"
#include "apps/settings/command_line.h"
#include "apps/submit/engine_table.h"
#include "apps/submit/submit_job.h"
#include "engine/error.h"
#include "engine/options/settings.h"

namespace vantage::apps {
namespace {

void add_submit_command_settings(Settings& settings, SubmitJob& job) {
  settings.positional("manifest", job.batch.manifest, "Items of 'vantage batch'; none: one run");
  add_run_settings(settings, job.batch.run);
  add_job_settings(settings, job.batch);
  add_submit_settings(settings, job.options);
  settings.set_short_help(
      {"manifest", "output", "engine", "go", "tasks", "cpus", "task-memory", "time", "concurrent",
       "retries", "image", "queue", "shards", "save", "preset"},
      {"vantage submit --engine kubernetes --image films/vantage films.csv -o s3://films/results",
       "vantage submit --engine sge films.csv -o results --go",
       "vantage submit --shards 40 --time 4:00:00 --left left/ --right right/ -o results --go"});
}

/// Whether the value is a path of this machine: no address, "-" or a word such as `none`.
bool is_own_path(const Setting& setting, const std::string& text) {
  const std::vector<std::string> words = split(setting.value_name, '|');
  return text != "-" && text.find("://") == std::string::npos &&
         std::ranges::find(words, text) == words.end();
}

/// Tasks start in other folders.
void make_paths_absolute(const Settings& settings) {
  for (const Setting& setting : settings.all()) {
    if (setting.path == PathRole::kNone || !settings.is_set(setting.name)) {
      continue;
    }
    std::vector<SettingValue> texts = to_list(setting.get());
    for (SettingValue& text : texts) {
      if (text.is_string() && is_own_path(setting, text.get<std::string>())) {
        text = std::filesystem::absolute(text.get<std::string>()).lexically_normal().string();
      }
    }
    setting.set(setting.list ? SettingValue(texts) : texts.front());
  }
}

}  // namespace

int command_submit(const Arguments& arguments) {
  SubmitJob job;
  Settings settings("submit",
                    "Runs the items of a manifest, or one divided run, as tasks of a cluster.");
  add_submit_command_settings(settings, job);
  if (!read_command_line(settings, arguments)) {
    return kExitDone;
  }
  const EngineEntry& engine = engine_entry(job.options.engine);
  check_engine_options(settings, engine);
  job.options.validate();
  if (engine.shares_files) {
    make_paths_absolute(settings);
  }
  if (!job.batch.manifest.empty()) {
    return submit_manifest(job, settings);
  }
  if (engine.engine != BatchEngine::kSlurm) {
    throw UsageError(
        "MANIFEST is missing, expected one: --engine slurm alone divides one run (--shards)");
  }
  settings.refuse_idle(
      {"tasks", "job-time", "attempts", "lease", "scratch", "scratch-limit", "keep-every"},
      "without a manifest");
  return submit_divided_run(job, settings);
}

}  // namespace vantage::apps
