#include "apps/run/resumed_run.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "apps/settings/command_line.h"
#include "engine/error.h"
#include "engine/io/files/encoded_text.h"
#include "engine/io/files/json_text.h"
#include "engine/io/files/remote_files.h"
#include "engine/io/video/streams/stream_input.h"
#include "engine/options/emptied_value.h"
#include "engine/options/match_settings.h"
#include "engine/sequence/journal/run_journal.h"
#include "engine/sequence/options/sequence_layout.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

constexpr std::array kSources = {"left",     "right",       "more",        "stereo", "pairs",
                                 "sequence", "calibration", "unrectified", "poses"};
constexpr const char* kKeepGoing = "keep-going";

bool names_input(const PairSourceOptions& input) {
  return !(input.left.empty() && input.right.empty() && input.stereo.empty() &&
           input.pairs.empty() && input.sequence.empty());
}

constexpr const char* kMergePart = "merge";  // of 'vantage merge', which computes no frames

/// The part of a name of RunSession::part_name(); other names are of the whole run.
RunPart part_of(const std::string& name) {
  static const std::regex form(
      "(?:frames-([0-9]{1,9})-([0-9]{1,9}))?-?(?:([0-9]{1,9})-of-([0-9]{1,9}))?");
  RunPart part;
  std::smatch numbers;
  if (std::regex_match(name, numbers, form)) {
    if (numbers[1].matched) {
      part.frames = FrameRange{std::stoi(numbers[1]), std::stoi(numbers[2]) + 1};
    }
    if (numbers[3].matched) {
      part.shard = Shard{std::stoi(numbers[3]), std::stoi(numbers[4])};
    }
  }
  return part;
}

constexpr const char* kRows = "rows";

/// What the journal of the run to resume says; empty where there is none.
std::optional<SettingValue> setting_to_resume(const RunJob& job, const char* name) {
  const fs::path journal = SequenceLayout(job.output, job.sequence).journal_folder();
  if (!job.resume || job.force || !RunJournal::is_present(journal)) {
    return std::nullopt;
  }
  const SettingValue settings =
      parse_json(RunJournal::read_identity(journal).settings, (journal / "run.json").string());
  const auto value = settings.find(name);
  return value == settings.end() ? std::nullopt : std::optional(*value);
}

}  // namespace

std::string sources_of(const RunJob& job, const Settings& settings) {
  const LargeValue all{settings.values()};
  const SettingValue& values = all.value;
  SettingValue sources = {{kKeepGoing, job.keep_going}};
  for (const char* name : kSources) {
    const auto stored = [](const SettingValue& path) {
      return is_stream_name(path.get<std::string>())
                 ? path
                 : SettingValue(stored_name(absolute_path(path.get<std::string>()).string()));
    };
    if (values[name].is_string()) {
      sources[name] = stored(values[name]);
    } else if (values[name].is_array()) {
      sources[name] = SettingValue::array();
      for (const SettingValue& path : values[name]) {
        sources[name].push_back(stored(path));
      }
    }
  }
  return sources.dump();
}

RunPart resumed_part(const fs::path& journal_folder) {
  std::vector<std::string> names = RunJournal::parts(journal_folder);
  std::erase(names, kMergePart);
  if (names.empty()) {
    return {};
  }
  RunPart common = part_of(names.front());
  if (names.size() > 1) {
    common.shard.reset();
  }
  for (const std::string& name : names) {
    if (part_of(name).frames != common.frames) {
      return {};
    }
  }
  return common;
}

void take_up_run(const Arguments& arguments, Settings& settings, RunJob& job) {
  if (!job.resume || names_input(job.input)) {
    return;
  }
  const fs::path journal = SequenceLayout(job.output, job.sequence).journal_folder();
  const RunIdentity identity = RunJournal::read_identity(journal);
  job = RunJob();
  try {
    settings.set_values(SettingValue::parse(identity.settings));
    settings.set_values(SettingValue::parse(identity.sources));
  } catch (const UsageError& error) {
    throw Error(fmt::format("{}: cannot be read as the settings of a run: {}",
                            (journal / "run.json").string(), error.what()));
  }
  (void)read_command_line(settings, arguments);
  if (!settings.is_set("frames") && !settings.is_set("shard")) {
    const RunPart part = resumed_part(journal);
    job.frames = part.frames;
    job.shard = part.shard;
  }
}

std::optional<DisparityRange> range_of_run_to_resume(const RunJob& job) {
  const std::optional<SettingValue> range = setting_to_resume(job, "disparities");
  return range ? std::optional(to_disparity_range(*range, "MIN:MAX in the journal")) : std::nullopt;
}

void take_up_rows(RunJob& job) {
  const std::optional<SettingValue> rows = setting_to_resume(job, kRows);
  if (job.rows == RowMode::kAuto && job.sequence.rows.keys.empty() && rows) {
    Settings settings("run", "");
    add_sequence_rows_setting(settings, job);
    settings.set_values({{kRows, *rows}});
  }
}

}  // namespace vantage::apps
