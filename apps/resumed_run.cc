#include "apps/resumed_run.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <regex>

#include "apps/match_settings.h"
#include "engine/error.h"
#include "engine/io/json_text.h"
#include "engine/io/stored_name.h"
#include "engine/sequence/run_journal.h"
#include "engine/sequence/sequence_layout.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

constexpr std::array kSources = {"left",  "right",    "more",        "stereo",
                                 "pairs", "sequence", "calibration", "poses"};
constexpr const char* kKeepGoing = "keep-going";

bool names_input(const PairSourceOptions& input) {
  return !(input.left.empty() && input.right.empty() && input.stereo.empty() &&
           input.pairs.empty() && input.sequence.empty());
}

/// Sets the part of the run from a name of RunSession::part_name(); ignores other names.
void take_part(const std::string& name, RunJob& job) {
  static const std::regex form("(?:frames-([0-9]+)-([0-9]+))?-?(?:([0-9]+)-of-([0-9]+))?");
  std::smatch numbers;
  if (!std::regex_match(name, numbers, form)) {
    return;
  }
  if (numbers[1].matched) {
    job.frames = FrameRange{std::stoi(numbers[1]), std::stoi(numbers[2]) + 1};
  }
  if (numbers[3].matched) {
    job.shard = Shard{std::stoi(numbers[3]), std::stoi(numbers[4])};
  }
}

}  // namespace

std::string sources_of(const RunJob& job, const Settings& settings) {
  const SettingValue values = settings.values();
  SettingValue sources = {{kKeepGoing, job.keep_going}};
  for (const char* name : kSources) {
    const auto stored = [](const SettingValue& path) {
      return path == "-"
                 ? path  // standard input
                 : SettingValue(stored_name(fs::absolute(path.get<std::string>()).string()));
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

void take_up_run(const Arguments& arguments, Settings& settings, RunJob& job) {
  if (!job.resume || names_input(job.input)) {
    return;
  }
  const fs::path journal = SequenceLayout(job.output, job.sequence).journal_folder();
  const RunIdentity identity = RunJournal::read_identity(journal);
  const std::vector<std::string> parts = RunJournal::parts(journal);
  job = RunJob();
  try {
    settings.set_values(SettingValue::parse(identity.settings));
    settings.set_values(SettingValue::parse(identity.sources));
  } catch (const UsageError& error) {
    throw Error(fmt::format("{}: cannot be read as the settings of a run: {}",
                            (journal / "run.json").string(), error.what()));
  }
  (void)settings.read(arguments);
  if (parts.size() == 1 && !job.frames && !job.shard) {
    take_part(parts.front(), job);
  }
}

std::optional<DisparityRange> range_of_run_to_resume(const RunJob& job) {
  const fs::path journal = SequenceLayout(job.output, job.sequence).journal_folder();
  if (!job.resume || job.force || !RunJournal::is_present(journal)) {
    return std::nullopt;
  }
  const SettingValue settings =
      parse_json(RunJournal::read_identity(journal).settings, (journal / "run.json").string());
  const auto range = settings.find("disparities");
  return range == settings.end()
             ? std::nullopt
             : std::optional(to_disparity_range(*range, "MIN:MAX in " + journal.string()));
}

}  // namespace vantage::apps
